// SPDX-License-Identifier: MIT
// The interpreter, with an eye on what it is about to store.
#include "emulator/engines/lockstep/trace.hpp"

#include <cstring>

#include "emulator/engines/translated/run/interpreter.hpp"
#include "firmware/protocol/hints.hpp"

namespace torolux::lockstep {
namespace {

using translated::CodeMap;
using translated::Instruction;
using translated::Interpreter;
using translated::Op;
using translated::TranslatedPe;

/// Whether the instruction, about to be executed, writes to the word at this address.
bool stores_to(const TranslatedPe& pe, const Instruction& i, std::uint32_t word) {
  const bool plain = (i.op >= Op::sb && i.op <= Op::sw) || i.op == Op::fsw;
  const bool atomic = i.op >= Op::sc && i.op <= Op::amomaxu;
  if (!plain && !atomic) return false;
  const std::uint32_t begin = pe.x[i.rs1] + (plain ? i.immediate : 0);
  const std::uint32_t bytes = i.op == Op::sb ? 1 : i.op == Op::sh ? 2 : 4;
  return begin < word + 4 && begin + bytes > word;
}

std::uint32_t word_at(const TranslatedPe& pe, std::uint32_t address) {
  std::uint32_t value = 0;
  std::memcpy(&value, pe.memory + (address - translated::kMemoryBase), sizeof value);
  return value;
}

}  // namespace

Trace trace_to_hint(const CodeMap& code, TranslatedPe& pe, std::optional<std::uint32_t> watched, TraceLimit limit) {
  const Interpreter interpreter(code);
  Trace trace;
  while (trace.instructions < limit.instructions && pe.cycles < limit.clock && !trace.at_hint) {
    const std::uint32_t pc = pe.pc;
    const translated::PlacedInstruction* placed = code.at(pc);
    const bool stores = watched && placed != nullptr && stores_to(pe, placed->instruction, *watched);
    const Interpreter::Step step = interpreter.step(pe);
    ++trace.instructions;
    if (placed != nullptr) {
      if (trace.last.size() == Trace::kMostKept) trace.last.pop_front();
      trace.last.push_back({pc, pe.cycles, placed->instruction});
    }
    if (stores) trace.store = {pc, pe.cycles, word_at(pe, *watched)};
    if (step == Interpreter::Step::stuck || step == Interpreter::Step::waits) break;
    trace.at_hint = step == Interpreter::Step::hint && !protocol::is_phase_marker(pe.hint_immediate);
  }
  return trace;
}

}  // namespace torolux::lockstep
