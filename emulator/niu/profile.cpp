// SPDX-License-Identifier: MIT
// Phases nest; each cycle belongs to the innermost one.
#include "emulator/niu/profile.hpp"

#include <span>

namespace torolux {

void report_mismatch(NiuChannel& channel, std::uint8_t phase, bool enters, std::uint64_t clock) {
  const ProcessorState& state = channel.processor;
  const std::uint32_t open = state.phase_depth != 0 ? state.phases[state.phase_depth - 1] : protocol::kPhases;
  const NiuFault fault{NiuFaultCode::phase_mismatch, {phase, open, enters ? 1U : 0U}};
  channel.commands.push({command_time(channel.processor, clock), CommandKind::fault, 0, 0, 0, 0, 0, 0},
                        std::as_bytes(std::span(&fault, 1)));
}

ProcessorMark mark_of(const NiuChannel& channel) {
  constexpr auto relaxed = std::memory_order_relaxed;
  ProcessorMark mark{};
  mark.clock = channel.clock.load(relaxed);
  mark.instructions = channel.instructions.load(relaxed);
  mark.copied = channel.copied.load(relaxed);
  for (std::size_t i = 0; i < kWaitReasons; ++i) mark.waits[i] = channel.waits[i].load(relaxed);
  for (std::size_t i = 0; i < protocol::kPhases; ++i) mark.phase_cycles[i] = channel.phase_cycles[i].load(relaxed);
  const ProcessorState& state = channel.processor;
  if (state.phase_depth != 0) {  // what the open phase has had since the last marker
    const std::uint64_t busy = mark.clock - state.waited;
    mark.phase_cycles[state.phases[state.phase_depth - 1]] += busy - state.phase_begin;
  }
  return mark;
}

void begin_stage(NiuChannel& channel, std::uint32_t stage) {
  ProcessorState& state = channel.processor;
  const ProcessorMark mark = mark_of(channel);
  while (state.stage < stage) state.marks[++state.stage] = mark;
}

}  // namespace torolux
