// SPDX-License-Identifier: MIT
// Backward over the blocks until nothing changes.
#include "emulator/engines/translated/analysis/liveness.hpp"

#include <array>
#include <optional>

namespace torolux::translated {
namespace {

constexpr std::uint32_t kMtvec = 0x305;

bool between(Op op, Op first, Op last) {
  return op >= first && op <= last;
}

/// Of floating-point arithmetic.
RegisterSet float_reads(const Instruction& i) {
  if (between(i.op, Op::fmadd, Op::fnmadd)) return f_register(i.rs1) | f_register(i.rs2) | f_register(i.rs3);
  switch (i.op) {
    case Op::fcvt_s_w:
    case Op::fcvt_s_wu:
    case Op::fmv_w_x:
      return x_register(i.rs1);
    case Op::fsqrt:
    case Op::fcvt_w_s:
    case Op::fcvt_wu_s:
    case Op::fmv_x_w:
    case Op::fclass:
      return f_register(i.rs1);
    default:
      return f_register(i.rs1) | f_register(i.rs2);
  }
}

/// Whether nobody knows where the program goes on behind it.
bool ends_flow(Op op) {
  return op == Op::illegal || op == Op::ecall || op == Op::ebreak || op == Op::mret || op == Op::wfi;
}

/// x registers whose value is known where the code runs straight on.
class Constants {
 public:
  void execute(const Instruction& i, std::uint32_t pc) {
    std::optional<std::uint32_t> value;
    if (i.op == Op::lui) value = i.immediate;
    if (i.op == Op::auipc) value = pc + i.immediate;
    if (i.op == Op::addi && this->value(i.rs1)) value = *this->value(i.rs1) + i.immediate;
    if (writes_x(i.op) && i.rd != 0) values_[i.rd] = value;
  }
  std::optional<std::uint32_t> value(unsigned n) const { return n == 0 ? std::optional<std::uint32_t>(0) : values_[n]; }

 private:
  std::array<std::optional<std::uint32_t>, 32> values_;
};

}  // namespace

RegisterSet reads_of(const Instruction& i) {
  const RegisterSet first = x_register(i.rs1);
  const RegisterSet second = x_register(i.rs2);
  if (between(i.op, Op::addi, Op::srai) || i.op == Op::jalr || between(i.op, Op::lb, Op::lhu) || i.op == Op::flw ||
      i.op == Op::lr || between(i.op, Op::csrrw, Op::csrrc)) {
    return first;
  }
  if (i.op == Op::fsw) return first | f_register(i.rs2);
  if (between(i.op, Op::add, Op::remu) || is_branch(i.op) || between(i.op, Op::sb, Op::sw) ||
      between(i.op, Op::sc, Op::amomaxu)) {
    return first | second;
  }
  return between(i.op, Op::fmadd, Op::fmv_w_x) ? float_reads(i) : 0;
}

RegisterSet writes_of(const Instruction& i) {
  if (writes_f(i.op)) return f_register(i.rd);
  return writes_x(i.op) ? x_register(i.rd) : 0;
}

bool may_write_mtvec(const Instruction& i) {
  return is_csr(i.op) && i.immediate == kMtvec && (i.op == Op::csrrw || i.op == Op::csrrwi || i.rs1 != 0);
}

bool may_trap(const Instruction& i) {
  return between(i.op, Op::lb, Op::fsw) || is_interpreted(i);
}

bool is_return(const Instruction& i) {
  return i.op == Op::jalr && i.rd == 0 && i.rs1 == 1 && i.immediate == 0;
}

Liveness::Liveness(const CodeMap& code, const Blocks& blocks) : code_(code), blocks_(blocks) {
  find_trap_handlers();
  for (const auto& [address, block] : blocks.all()) live_[address] = 0;
  while (update()) {
  }
}

/// Where `csrw mtvec` is given an address that the instructions before it make.
void Liveness::find_trap_handlers() {
  std::set<std::uint32_t> understood;
  for (const std::uint32_t function : blocks_.functions()) {
    Constants constants;
    for (std::uint32_t pc = function; const PlacedInstruction* placed = code_.at(pc);) {
      const Instruction& i = placed->instruction;
      if (i.op == Op::jal || i.op == Op::jalr || ends_flow(i.op)) break;
      if (may_write_mtvec(i) && i.op == Op::csrrw && constants.value(i.rs1)) {
        understood.insert(pc);
        trap_handlers_.insert(*constants.value(i.rs1));
      }
      constants.execute(i, pc);
      pc += i.bytes;
    }
  }
  for (std::uint32_t pc = code_.begin(); pc < code_.end(); pc += 2) {
    const PlacedInstruction* placed = code_.at(pc);
    foreign_trap_handler_ |= placed != nullptr && may_write_mtvec(placed->instruction) && !understood.contains(pc);
  }
}

RegisterSet Liveness::at(std::uint32_t address) const {
  const auto found = live_.find(address);
  return found == live_.end() ? kAllRegisters : found->second;
}

RegisterSet Liveness::flows_on(const Block& block) const {
  switch (block.ending) {
    case Ending::branch:
      return at(block.target) | at(block.end);
    case Ending::jump:
      return at(block.target);
    case Ending::indirect:
      return kAllRegisters;
    case Ending::interpreted: {
      const PlacedInstruction* placed = code_.at(block.end);
      if (placed == nullptr || ends_flow(placed->instruction.op)) return kAllRegisters;
      return before(placed->instruction, at(block.end + placed->instruction.bytes));
    }
    default:
      return at(block.end);
  }
}

bool Liveness::update() {
  bool changed = false;
  const auto grow = [&](RegisterSet& set, RegisterSet more) {
    changed |= (more & ~set) != 0;
    set |= more;
  };
  for (auto found = blocks_.all().rbegin(); found != blocks_.all().rend(); ++found) {
    const Block& block = found->second;
    RegisterSet live = behind(block);
    const std::vector<std::uint32_t> addresses = addresses_in(code_, block);
    for (auto pc = addresses.rbegin(); pc != addresses.rend(); ++pc) live = before(code_.at(*pc)->instruction, live);
    grow(live_[block.begin], live);
  }
  RegisterSet in_traps = foreign_trap_handler_ ? kAllRegisters : 0;
  for (const std::uint32_t handler : trap_handlers_) in_traps |= at(handler);
  grow(in_traps_, in_traps);
  return changed;
}

}  // namespace torolux::translated
