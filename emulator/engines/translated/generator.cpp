// SPDX-License-Identifier: MIT
// The frame around the blocks of a region: loading and saving registers, jumps between blocks, ways out.
#include "emulator/engines/translated/generator.hpp"

#include <algorithm>

#include "emulator/engines/translated/block_writer.hpp"

namespace torolux::translated {
namespace {

std::string label(std::uint32_t address) {
  std::string text = hexadecimal(address);
  return "b_" + text.substr(2, 8);
}

class RegionWriter {
 public:
  RegionWriter(const CodeMap& code, const Blocks& blocks, const Region& region)
      : code_(code), blocks_(blocks), region_(region), writer_(code, blocks.observed(), body_, use_) {}

  std::string text(std::size_t number);

 private:
  bool inside(std::uint32_t address) const { return std::binary_search(region_.begin(), region_.end(), address); }
  void write_block(const Block& block);
  void write_ending(const Block& block);
  void write_jump(const Block& block, const Instruction& i);
  void write_indirect(const Block& block, const Instruction& i);
  std::string go_to(std::uint32_t from, std::uint32_t address) const;
  std::string places() const;
  std::string registers(const char* x_text, const char* f_text, const std::bitset<32>& x,
                        const std::bitset<32>& f) const;

  const CodeMap& code_;
  const Blocks& blocks_;
  const Region& region_;
  std::string body_;
  RegisterUse use_;
  BlockWriter writer_;
};

/// A jump backwards also looks at the time.
std::string RegionWriter::go_to(std::uint32_t from, std::uint32_t address) const {
  const std::string away = "{ at = " + hexadecimal(address) + "; goto leave; }";
  if (!inside(address)) return away;
  const std::string there = "goto " + label(address) + ";";
  if (address > from) return there;
  return "{ if (TOROLUX_RARELY(static_cast<std::uint32_t>(count) >= slice)) { at = " + hexadecimal(address) +
         "; goto out_of_time; } " + there + " }";
}

void RegionWriter::write_jump(const Block& block, const Instruction& i) {
  if (i.rd != 0) writer_.line(writer_.assign_x(i.rd) + hexadecimal(block.end) + ";");
  writer_.line(go_to(block.last, block.target));
}

void RegionWriter::write_indirect(const Block& block, const Instruction& i) {
  writer_.line("at = (" + writer_.x(i.rs1) + " + " + hexadecimal(i.immediate) + ") & ~1u;");
  if (i.rd != 0) writer_.line(writer_.assign_x(i.rd) + hexadecimal(block.end) + ";");
  writer_.line("goto dispatch;");
}

void RegionWriter::write_ending(const Block& block) {
  const auto last = [&]() -> const Instruction& { return code_.at(block.last)->instruction; };
  switch (block.ending) {
    case Ending::branch: {
      const std::string condition = writer_.condition(last());
      writer_.line("if (" + condition + ") " + go_to(block.last, block.target));
      writer_.line(go_to(block.last, block.end));
      break;
    }
    case Ending::jump:
      write_jump(block, last());
      break;
    case Ending::indirect:
      write_indirect(block, last());
      break;
    case Ending::hint:
      writer_.line("pe->hint_immediate = " + std::to_string(static_cast<std::int32_t>(last().immediate)) + ";");
      writer_.line("at = " + hexadecimal(block.end) + "; goto hint;");
      break;
    case Ending::interpreted:
      writer_.line("at = " + hexadecimal(block.end) + "; goto leave;");
      break;
    case Ending::next:
      writer_.line(go_to(block.begin, block.end));
      break;
  }
}

void RegionWriter::write_block(const Block& block) {
  body_ += label(block.begin) + ":\n";
  if (block.cost.cycles != 0) writer_.line("count += " + std::to_string(pack(block.cost)) + "ull;");
  const bool has_jump = block.ending != Ending::next && block.ending != Ending::interpreted;
  Cost behind = block.cost;
  for (std::uint32_t pc = block.begin; pc < block.end;) {
    const PlacedInstruction& placed = *code_.at(pc);
    behind.cycles -= placed.cost.cycles;
    behind.instructions -= placed.cost.instructions;
    if (pc == block.last && has_jump) break;
    writer_.write(placed.instruction, pc, behind);
    pc += placed.instruction.bytes;
  }
  writer_.settle();
  write_ending(block);
}

std::string RegionWriter::places() const {
  const std::uint32_t begin = region_.front();
  const std::uint32_t end = region_.back() + 2;
  std::string text = "  static const int places[] = {";
  for (std::uint32_t address = begin; address < end; address += 2) {
    const auto found = blocks_.all().find(address);
    const bool is_entry = found != blocks_.all().end() && found->second.entry && inside(address);
    text += is_entry ? "\n    (int)((char*)&&" + label(address) + " - (char*)&&leave)," : "0,";
  }
  return text + "};\n";
}

std::string RegionWriter::registers(const char* x_text, const char* f_text, const std::bitset<32>& x,
                                    const std::bitset<32>& f) const {
  std::string text;
  const auto add = [&](std::string pattern, unsigned n) {
    for (std::size_t at = 0; (at = pattern.find('$', at)) != std::string::npos;) {
      pattern.replace(at, 1, std::to_string(n));
    }
    text += "  " + pattern + "\n";
  };
  for (unsigned n = 1; n < 32; ++n) {
    if (x.test(n)) add(x_text, n);
  }
  for (unsigned n = 0; n < 32; ++n) {
    if (f.test(n)) add(f_text, n);
  }
  return text;
}

std::string RegionWriter::text(std::size_t number) {
  for (const std::uint32_t address : region_) write_block(blocks_.all().at(address));
  const char* header = blocks_.observed() ? "flagged" : "translated_code";
  std::string text = std::string("#include \"emulator/engines/translated/semantics/") + header + ".hpp\"\n";
  text += "using namespace torolux::translated;\n";
  text += "extern \"C\" __attribute__((visibility(\"default\"))) std::uint32_t " + region_name(number) +
          "(TranslatedPe* pe) {\n" + places();
  text += "  std::byte* const memory = pe->memory;\n";
  text += "  std::byte* const stores = memory + " + hexadecimal(code_.store_base() - kMemoryBase) + ";\n";
  text += "  const std::uint32_t load_limit = pe->load_limit, store_limit = pe->store_limit, slice = pe->slice;\n";
  text += "  std::uint64_t count = 0;\n  std::uint32_t at = pe->pc;\n  Exit why = Exit::jump;\n";
  text += registers("std::uint32_t x$ = pe->x[$];", "float f$ = from_bits(pe->f[$]);", use_.x, use_.f);
  if (blocks_.observed()) text += "  clear_host_flags();\n";
  text += "dispatch:\n  {\n    const std::uint32_t o = at - " + hexadecimal(region_.front()) + ";\n";
  text += "    if (TOROLUX_RARELY(o >= " + hexadecimal(region_.back() + 2 - region_.front()) + ")) goto leave;\n";
  text += "    if (TOROLUX_RARELY(static_cast<std::uint32_t>(count) >= slice)) goto out_of_time;\n";
  text += "    goto *(void*)((char*)&&leave + places[o >> 1u]);\n  }\n";
  text += body_;
  text += "hint:\n  why = Exit::hint;\n  goto leave;\nlook:\n  why = Exit::look;\n  goto leave;\n";
  text += "out_of_time:\n  why = Exit::slice;\nleave:\n  pe->pc = at;\n  pe->count = count;\n";
  text += registers("pe->x[$] = x$;", "pe->f[$] = to_bits(f$);", use_.x_written, use_.f_written);
  if (blocks_.observed()) text += "  pe->fflags |= host_flags();\n  clear_host_flags();\n";
  return text + "  return static_cast<std::uint32_t>(why);\n}\n";
}

}  // namespace

std::string region_name(std::size_t number) {
  return "region_" + std::to_string(number);
}

std::string generate_region(const CodeMap& code, const Blocks& blocks, const Region& region, std::size_t number) {
  return RegionWriter(code, blocks, region).text(number);
}

}  // namespace torolux::translated
