// SPDX-License-Identifier: MIT
// The frame around the blocks of a function: loading and saving registers, jumps between blocks, calls, ways out.
#include "emulator/engines/translated/generate/generator.hpp"

#include "emulator/engines/translated/generate/block_writer.hpp"
#include "emulator/engines/translated/generate/function_flow.hpp"

namespace torolux::translated {
namespace {

std::string flow_label(std::uint32_t address) {
  return "b_" + hexadecimal(address).substr(2, 8);
}
std::string entry_label(std::uint32_t address) {
  return "r_" + hexadecimal(address).substr(2, 8);
}
std::string called_name(std::uint32_t begin) {
  return "called_" + hexadecimal(begin).substr(2, 8);
}
std::string resumed_name(std::uint32_t begin) {
  return "resumed_" + hexadecimal(begin).substr(2, 8);
}

using Numbers = std::map<std::uint32_t, std::size_t>;  // of functions, by where they begin

class FunctionWriter {
 public:
  FunctionWriter(const CodeMap& code, const Blocks& blocks, const FunctionFlow& flow, const Numbers& numbers,
                 const GuestFunction& function, bool resumes)
      : code_(code),
        blocks_(blocks),
        flow_(flow),
        numbers_(numbers),
        function_(function),
        resumes_(resumes),
        writer_(code, blocks.observed(), body_) {}

  std::string text(const std::string& name);

 private:
  void write_block(const Block& block);
  void write_ending(const Block& block, RegisterSet save);
  void write_call(const Block& block, RegisterSet save);
  void write_indirect(const Block& block, const Instruction& i, RegisterSet save);
  std::string go_to(const Block& block, std::uint32_t address, RegisterSet save) const;
  std::string leave(RegisterSet save, Exit why, std::uint32_t at) const;
  std::string dispatch() const;

  const CodeMap& code_;
  const Blocks& blocks_;
  const FunctionFlow& flow_;
  const Numbers& numbers_;
  const GuestFunction& function_;
  bool resumes_;
  std::string body_;
  BlockWriter writer_;
};

std::string FunctionWriter::leave(RegisterSet save, Exit why, std::uint32_t at) const {
  return writer_.leave(save,
                       "left_for(Exit(" + std::to_string(static_cast<unsigned>(why)) + "), " + hexadecimal(at) + ")");
}

/// A jump backwards also looks at the time, and so does code that goes on without one for very long.
std::string FunctionWriter::go_to(const Block& block, std::uint32_t address, RegisterSet save) const {
  std::string there = "goto " + flow_label(address) + ";";
  if (!flow_.inside(address)) {
    const auto callee = numbers_.find(address);
    if (callee == numbers_.end()) return leave(save, Exit::jump, address);
    there = "{ if (TOROLUX_RARELY(depth >= kDeepest || count >= slice)) " + leave(save, Exit::jump, address) + " " +
            writer_.save(save) + "return " + called_name(callee->first) + "(pe, count, " + hexadecimal(address) +
            ", depth + 1); }";
  }
  constexpr unsigned kLong = 20;  // 2^20 bytes
  if (address > block.begin && address >> kLong == block.begin >> kLong) return there;
  return "{ if (TOROLUX_RARELY(count >= slice)) " + leave(save, Exit::slice, address) + " " + there + " }";
}

void FunctionWriter::write_call(const Block& block, RegisterSet save) {
  writer_.line(BlockWriter::assign_x(code_.at(block.last)->instruction.rd) + hexadecimal(block.end) + ";");
  const auto callee = numbers_.find(block.target);
  if (callee == numbers_.end()) {
    writer_.line(leave(save, Exit::jump, block.target));
    return;
  }
  writer_.line("if (TOROLUX_RARELY(depth >= kDeepest || count >= slice)) " + leave(save, Exit::jump, block.target));
  writer_.line(writer_.save(save));
  writer_.line("const Left left = " + called_name(callee->first) + "(pe, count, " + hexadecimal(block.target) +
               ", depth + 1);");
  writer_.line("count = left.count;");
  writer_.line("if (TOROLUX_RARELY(left.at != " + hexadecimal(block.end) + ")) return left;");
  if (flow_.inside(block.end)) {
    writer_.line(BlockWriter::load(flow_.needed(block.end)));
    writer_.line("goto " + flow_label(block.end) + ";");
  } else {
    writer_.line("return {count, left_for(Exit::jump, " + hexadecimal(block.end) + ")};");
  }
}

void FunctionWriter::write_indirect(const Block& block, const Instruction& i, RegisterSet save) {
  writer_.line("at = (" + BlockWriter::x(i.rs1) + " + " + hexadecimal(i.immediate) + ") & ~1u;");
  if (i.rd != 0) writer_.line(BlockWriter::assign_x(i.rd) + hexadecimal(block.end) + ";");
  if (is_return(i)) {
    writer_.line(writer_.leave(save, "at"));
    return;
  }
  writer_.line(writer_.save(save));
  writer_.line("goto dispatch;");
}

void FunctionWriter::write_ending(const Block& block, RegisterSet save) {
  const auto last = [&]() -> const Instruction& { return code_.at(block.last)->instruction; };
  switch (block.ending) {
    case Ending::branch: {
      const std::string condition = writer_.condition(last());
      writer_.line("if (" + condition + ") " + go_to(block, block.target, save));
      writer_.line(go_to(block, block.end, save));
      break;
    }
    case Ending::jump:
      if (last().rd != 0) {
        write_call(block, save);
      } else {
        writer_.line(go_to(block, block.target, save));
      }
      break;
    case Ending::indirect:
      write_indirect(block, last(), save);
      break;
    case Ending::hint:
      writer_.line("if (TOROLUX_RARELY(!ask(pe, count, " + std::to_string(static_cast<std::int32_t>(last().immediate)) +
                   "))) " + leave(save, Exit::hint, block.end));
      writer_.line(go_to(block, block.end, save));
      break;
    case Ending::interpreted:
      writer_.line(leave(save, Exit::jump, block.end));
      break;
    case Ending::next:
      writer_.line(go_to(block, block.end, save));
      break;
  }
}

void FunctionWriter::write_block(const Block& block) {
  if (flow_.is_entry(block)) {
    body_ += entry_label(block.begin) + ":\n";
    writer_.line(BlockWriter::load(flow_.needed(block.begin)));
  }
  body_ += flow_label(block.begin) + ": {\n";
  const std::vector<std::uint32_t> addresses = addresses_in(code_, block);
  const std::vector<RegisterSet> saves = flow_.saved(block);
  writer_.begin(flow_.raw(block.begin), flow_.checks(block));
  if (block.cost.cycles != 0) writer_.line("count += " + std::to_string(pack(block.cost)) + "ull;");
  const bool has_jump = block.ending != Ending::next && block.ending != Ending::interpreted;
  Cost behind = block.cost;
  for (std::size_t n = 0; n < addresses.size(); ++n) {
    const PlacedInstruction& placed = *code_.at(addresses[n]);
    behind.cycles -= placed.cost.cycles;
    behind.instructions -= placed.cost.instructions;
    if (addresses[n] == block.last && has_jump) break;
    writer_.write(placed.instruction, addresses[n], behind, saves[n]);
  }
  writer_.canonicalize(flow_.to_canonicalize(block, writer_.raw()));
  write_ending(block, saves.back());
  body_ += "}\n";
}

/// Everything is saved; `at` says where to go on.
std::string FunctionWriter::dispatch() const {
  std::string text = "dispatch:\n  if (TOROLUX_RARELY(count >= slice)) ";
  text += "return {count, left_for(Exit::slice, static_cast<std::uint32_t>(at))};\n";
  text += "  switch (static_cast<std::uint32_t>(at)) {\n";
  for (const std::uint32_t address : function_.blocks) {
    if (!flow_.is_entry(blocks_.all().at(address))) continue;
    text += "    case " + hexadecimal(address) + ": goto " + entry_label(address) + ";\n";
  }
  return text + "    default: return {count, left_for(Exit::jump, static_cast<std::uint32_t>(at))};\n  }\n";
}

std::string FunctionWriter::text(const std::string& name) {
  for (const std::uint32_t address : function_.blocks) write_block(blocks_.all().at(address));
  std::string text = "extern \"C\" Left " + name +
                     "(TranslatedPe* pe, std::uint64_t count, std::uint64_t at, std::uint32_t depth) {\n  ";
  for (unsigned n = 1; n < 32; ++n) text += "std::uint32_t x" + std::to_string(n) + "; ";
  for (unsigned n = 0; n < 32; ++n) text += "float f" + std::to_string(n) + "; ";
  text += "\n  const std::uintptr_t memory = reinterpret_cast<std::uintptr_t>(pe->memory) - kMemoryBase;\n";
  text +=
      "  const std::uint32_t load_limit = pe->load_limit, store_limit = pe->store_limit;\n  const std::uint64_t slice "
      "= pe->slice;\n";
  if (!resumes_) text += "  goto " + entry_label(function_.begin) + ";\n";
  return text + dispatch() + body_ + "}\n";
}

/// What `run` looks for in the shared object. The host's flags are sticky, so it suffices to collect them at the end.
std::string tables(bool observed, const std::string& called, const std::string& resumed) {
  const std::string visible = "extern \"C\" __attribute__((visibility(\"default\"))) ";
  std::string text;
  for (const auto& [name, entries] : {std::pair(kCalledTable, called), std::pair(kResumedTable, resumed)}) {
    text += visible + "const HostFunction " + name + "[];\n";
    text += "const HostFunction " + std::string(name) + "[] = {" + entries + "};\n";
  }
  text += visible + "Left " + kEnter + "(TranslatedPe* pe, HostFunction function) {\n";
  if (observed) text += "  clear_host_flags();\n";
  text += "  const Left left = function(pe, 0, pe->pc, 0);\n";
  if (observed) text += "  pe->fflags |= host_flags();\n  clear_host_flags();\n";
  return text + "  return left;\n}\n";
}

}  // namespace

std::vector<SourceText> generate(const CodeMap& code, const Blocks& blocks, const Liveness& liveness,
                                 const std::vector<GuestFunction>& functions) {
  const std::string header = std::string("#include \"emulator/engines/translated/semantics/") +
                             (blocks.observed() ? "flagged" : "translated_code") +
                             ".hpp\"\nusing namespace torolux::translated;\n";
  std::string declarations = header;
  Numbers numbers;
  std::string called_table;
  std::string resumed_table;
  for (std::size_t n = 0; n < functions.size(); ++n) {
    for (const std::string& name : {called_name(functions[n].begin), resumed_name(functions[n].begin)}) {
      declarations += "extern \"C\" __attribute__((visibility(\"hidden\"))) Left " + name +
                      "(TranslatedPe*, std::uint64_t, std::uint64_t, std::uint32_t);\n";
    }
    called_table += called_name(functions[n].begin) + ", ";
    resumed_table += resumed_name(functions[n].begin) + ", ";
    if (!functions[n].blocks.empty() && blocks.all().contains(functions[n].begin)) numbers[functions[n].begin] = n;
  }
  std::vector<SourceText> units;
  constexpr std::size_t kMostText = 400'000;  // of a unit: units are compiled side by side
  std::string unit = declarations;
  const auto finish = [&] {
    units.push_back({"unit_" + std::to_string(units.size()) + ".cpp", unit});
    unit = declarations;
  };
  for (std::size_t n = 0; n < functions.size(); ++n) {
    for (const bool resumes : {false, true}) {
      const FunctionFlow flow(code, blocks, liveness, functions[n], resumes);
      const std::string name = (resumes ? resumed_name : called_name)(functions[n].begin);
      unit += FunctionWriter(code, blocks, flow, numbers, functions[n], resumes).text(name);
      if (unit.size() > kMostText) finish();
    }
  }
  unit += tables(blocks.observed(), called_table, resumed_table);
  finish();
  return units;
}

}  // namespace torolux::translated
