// SPDX-License-Identifier: MIT
// A PE, one instruction after the other, with its profile looking on. Apart from the loop that everybody else runs.
#include "emulator/engines/translated/run/translated_image.hpp"
#include "emulator/profile/pe_profile.hpp"

namespace torolux::translated {
namespace {

using profile::Flow;

constexpr std::uint8_t kStackPointer = 2;

bool links(std::uint8_t x) {
  return x == 1 || x == 5;
}

Flow flow_of_jump(const Instruction& i) {
  if (i.op == Op::jal) return links(i.rd) ? Flow::call : Flow::on;
  if (!links(i.rd)) return links(i.rs1) ? Flow::back : Flow::on;
  return links(i.rs1) && i.rs1 != i.rd ? Flow::swap : Flow::call;
}

/// How `i` at `pc` has passed control on to `to`. A trap shows by a place that the instruction itself could not go to.
Flow flow_of(const Instruction& i, std::uint32_t pc, std::uint32_t to) {
  if (is_branch(i.op)) return Flow::on;
  if (i.op == Op::jal || i.op == Op::jalr) return flow_of_jump(i);
  if (i.op == Op::mret) return Flow::trap_return;
  return to == pc + i.bytes ? Flow::on : Flow::trap;
}

}  // namespace

TranslatedImage::Stop TranslatedImage::run_profiled(TranslatedPe& pe, profile::PeProfile& profile) const {
  const auto tell = [&](Flow flow, std::uint32_t link) {
    profile.executed(flow, {pe.pc, pe.x[kStackPointer], pe.cycles}, link);
  };
  tell(Flow::on, pe.pc);  // the HINT at which it stood was told of when it had waited
  while (pe.cycles < pe.cycle_limit) {
    const std::uint32_t pc = pe.pc;
    const std::uint64_t executed = pe.instructions;
    const PlacedInstruction* placed = code_.at(pc);
    const Interpreter::Step step = interpret(pe);
    if (step != Interpreter::Step::done) {
      if (const auto stop = stop_of(step, pe)) return *stop;
    }
    // What cannot be fetched is not executed, nor counted. Phase markers are not counted, either, but never jump.
    const bool fetched = placed != nullptr && (pe.instructions != executed || placed->instruction.op == Op::hint);
    if (fetched)
      tell(flow_of(placed->instruction, pc, pe.pc), pc + placed->instruction.bytes);
    else
      tell(Flow::trap, pc);
  }
  return Stop::cycle_limit;
}

}  // namespace torolux::translated
