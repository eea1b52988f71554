// SPDX-License-Identifier: MIT
// Follows the flow of control from everything that looks like the address of code.
#include "emulator/engines/translated/analysis/blocks.hpp"

#include <algorithm>

namespace torolux::translated {
namespace {

constexpr std::uint8_t kNearest = 0;
constexpr std::uint8_t kTowardsZero = 1;

bool ends_block(const Instruction& i, const Cost& cost) {
  return is_branch(i.op) || i.op == Op::jal || i.op == Op::jalr || (i.op == Op::hint && cost.instructions != 0);
}

bool reads_float_state(const Instruction& i) {
  constexpr std::uint32_t kFflags = 0x001, kFcsr = 0x003, kMstatus = 0x300;
  return is_csr(i.op) && i.rd != 0 && (i.immediate == kFflags || i.immediate == kFcsr || i.immediate == kMstatus);
}

bool rounds_to_integer(Op op) {
  return op == Op::fcvt_w_s || op == Op::fcvt_wu_s;
}

}  // namespace

bool is_interpreted(const Instruction& i) {
  switch (i.op) {
    case Op::illegal:
    case Op::ecall:
    case Op::ebreak:
    case Op::mret:
    case Op::wfi:
    case Op::fclass:
      return true;
    default:
      break;
  }
  if (is_csr(i.op) || (i.op >= Op::lr && i.op <= Op::amomaxu)) return true;
  if (i.op >= Op::fmadd && i.op <= Op::fsqrt) return i.rounding != kNearest && i.rounding != kDynamic;
  if (i.op == Op::fcvt_s_w || i.op == Op::fcvt_s_wu) return i.rounding != kNearest && i.rounding != kDynamic;
  return rounds_to_integer(i.op) && i.rounding != kTowardsZero;
}

std::vector<std::uint32_t> addresses_in(const CodeMap& code, const Block& block) {
  std::vector<std::uint32_t> addresses;
  for (std::uint32_t pc = block.begin; pc < block.end; pc += code.at(pc)->instruction.bytes) addresses.push_back(pc);
  return addresses;
}

Blocks::Blocks(const Image& image, const CodeMap& code) : code_(code), traits_((code.end() - code.begin()) / 2) {
  find_roots(image);
  follow_all();
  fill_functions(image);
  divide_long_functions();
  for (std::uint32_t address = code.begin(); address < code.end(); address += 2) {
    // In code that seems out of reach, too: it may be interpreted.
    const PlacedInstruction* placed = code.at(address);
    observed_ |= placed != nullptr && reads_float_state(placed->instruction);
    const Traits& traits = at(address);
    if (traits.reached && traits.leader) blocks_.emplace(address, make_block(address));
    if (traits.reached && traits.function) functions_.push_back(address);
  }
}

/// Host compilers take more than linear time for a function: what is very long is made of several.
void Blocks::divide_long_functions() {
  constexpr unsigned kMostInstructions = 4096;  // of code from a compiler, few functions have half as many
  unsigned count = 0;
  for (std::uint32_t address = code_.begin(); address < code_.end(); address += 2) {
    Traits& traits = at(address);
    if (!traits.reached) continue;
    if (++count > kMostInstructions) traits.leader = traits.function = true;
    if (traits.function) count = 0;
  }
}

void Blocks::lead(std::uint32_t address, bool entry) {
  if (code_.at(address) == nullptr) return;
  Traits& traits = at(address);
  traits.leader = true;
  traits.entry |= entry;
  if (!traits.reached) waiting_.push_back(address);
}

/// An address that stands somewhere, unless constants lie there.
void Blocks::take(std::uint32_t address) {
  if (address % 2 != 0 || address >= end_of_functions_ || code_.at(address) == nullptr) return;
  lead(address, true);
  at(address).taken = true;
}

/// Symbols, the start, and every word of the image or constant in code that could be an address of code.
void Blocks::find_roots(const Image& image) {
  for (const ImageSymbol& symbol : image.symbols) {
    if (symbol.function) end_of_functions_ = std::max(end_of_functions_, symbol.address + symbol.bytes);
  }
  if (end_of_functions_ == 0) end_of_functions_ = code_.end();
  lead(image.entry, true);
  at(image.entry).function = true;
  for (const ImageSymbol& symbol : image.symbols) {
    if (code_.at(symbol.address) == nullptr || symbol.address >= end_of_functions_) continue;
    lead(symbol.address, true);
    at(symbol.address).function |= symbol.bytes != 0;
  }
  for (const ImageSegment& segment : image.segments) {
    for (std::size_t offset = 0; offset + 4 <= segment.contents.size(); offset += 4) {
      std::uint32_t word = 0;
      for (unsigned i = 0; i < 4; ++i) {
        word |= std::to_integer<std::uint32_t>(segment.contents[offset + i]) << (8U * i);
      }
      take(word);
    }
  }
}

void Blocks::follow_all() {
  while (!waiting_.empty()) {
    const std::uint32_t from = waiting_.back();
    waiting_.pop_back();
    follow(from);
  }
}

/// What nothing leads to inside a function is reached by a table of offsets.
void Blocks::fill_functions(const Image& image) {
  for (const ImageSymbol& symbol : image.symbols) {
    if (!symbol.function) continue;
    for (std::uint32_t pc = symbol.address; pc - symbol.address < symbol.bytes;) {
      const PlacedInstruction* placed = code_.at(pc);
      if (placed == nullptr) break;
      if (!at(pc).reached) {
        take(pc);
        follow_all();
      }
      pc += placed->instruction.bytes;
    }
  }
}

/// The pair `lui` or `auipc`, `addi` (or jalr) makes an address.
void Blocks::find_constants(std::uint32_t pc, const Instruction& first) {
  if (first.op != Op::lui && first.op != Op::auipc) return;
  const std::uint32_t high = first.op == Op::lui ? first.immediate : pc + first.immediate;
  constexpr unsigned kNear = 4;  // the compiler may put others in between
  std::uint32_t address = pc + first.bytes;
  for (unsigned n = 0; n < kNear; ++n) {
    const PlacedInstruction* second = code_.at(address);
    if (second == nullptr) return;
    const Instruction& i = second->instruction;
    if ((i.op == Op::addi || i.op == Op::jalr) && i.rs1 == first.rd) {
      const std::uint32_t target = high + i.immediate;
      take(target);
      return;
    }
    address += i.bytes;
  }
}

void Blocks::follow_flow(const Instruction& i, std::uint32_t pc) {
  const std::uint32_t next = pc + i.bytes;
  const bool is_call = (i.op == Op::jal || i.op == Op::jalr) && i.rd != 0;
  if (is_branch(i.op) || i.op == Op::jal) {
    const std::uint32_t target = pc + i.immediate;
    const bool backward = target <= pc;
    lead(target, backward || is_call);
    if (is_call && code_.at(target) != nullptr) at(target).function = true;
  }
  if (is_branch(i.op)) lead(next);
  if (is_call || i.op == Op::hint || is_interpreted(i)) lead(next, true);
}

void Blocks::follow(std::uint32_t from) {
  for (std::uint32_t pc = from;;) {
    const PlacedInstruction* placed = code_.at(pc);
    if (placed == nullptr || at(pc).reached) return;
    at(pc).reached = true;
    const Instruction& i = placed->instruction;
    find_constants(pc, i);
    if (is_interpreted(i) || ends_block(i, placed->cost)) return follow_flow(i, pc);
    pc += i.bytes;
    // Where it meets what another run has reached, a block begins.
    if (code_.at(pc) != nullptr && at(pc).reached) at(pc).leader = true;
  }
}

std::size_t Blocks::function_of(std::uint32_t address) const {
  const auto behind = std::upper_bound(functions_.begin(), functions_.end(), address);
  return behind == functions_.begin() ? 0 : static_cast<std::size_t>(behind - functions_.begin()) - 1;
}

void Blocks::make_entry(std::uint32_t address) {
  const auto found = blocks_.find(address);
  if (found != blocks_.end()) found->second.entry = found->second.end != found->second.begin;
}

Block Blocks::make_block(std::uint32_t begin) const {
  const Traits& traits = traits_[(begin - code_.begin()) / 2];
  Block block{begin, begin, begin, 0, Ending::next, traits.entry, traits.taken, {0, 0}};
  for (;;) {
    const PlacedInstruction* placed = code_.at(block.end);
    const bool next_begins = block.end != begin && placed != nullptr && traits_[(block.end - code_.begin()) / 2].leader;
    if (next_begins) return block;
    if (placed == nullptr || is_interpreted(placed->instruction)) {
      block.ending = Ending::interpreted;
      if (block.end == begin) block.entry = false;
      return block;
    }
    const Instruction& i = placed->instruction;
    block.last = block.end;
    block.end += i.bytes;
    block.cost.cycles += placed->cost.cycles;
    block.cost.instructions += placed->cost.instructions;
    if (!ends_block(i, placed->cost)) continue;
    block.target = block.last + i.immediate;
    block.ending = is_branch(i.op)    ? Ending::branch
                   : i.op == Op::jal  ? Ending::jump
                   : i.op == Op::jalr ? Ending::indirect
                                      : Ending::hint;
    return block;
  }
}

}  // namespace torolux::translated
