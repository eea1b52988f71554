// SPDX-License-Identifier: MIT
// Phases nest; each cycle belongs to the innermost one.
#include "emulator/niu/profile.hpp"

#include <span>

#include "firmware/protocol/hints.hpp"

namespace torolux {

namespace {

using protocol::Hint;

constexpr auto kLeave = static_cast<std::int32_t>(Hint::leave_phase);

void charge(NiuChannel& channel, std::uint64_t clock) {
  ProcessorState& state = channel.processor;
  const std::uint64_t busy = clock - waited_cycles(channel);
  if (state.phase_depth != 0) {
    auto& cycles = channel.phase_cycles[state.phases[state.phase_depth - 1]];
    cycles.store(cycles.load(std::memory_order_relaxed) + busy - state.phase_begin, std::memory_order_relaxed);
  }
  state.phase_begin = busy;
}

void report_mismatch(NiuChannel& channel, std::uint8_t phase, std::uint64_t clock) {
  const ProcessorState& state = channel.processor;
  const std::uint32_t open = state.phase_depth != 0 ? state.phases[state.phase_depth - 1] : protocol::kPhases;
  const NiuFault fault{NiuFaultCode::phase_mismatch, {phase, open, 0}};
  channel.commands.push({command_time(channel.processor, clock), CommandKind::fault, 0, 0, 0, 0, 0},
                        std::as_bytes(std::span(&fault, 1)));
}

}  // namespace

bool mark_phase(NiuChannel& channel, std::int32_t immediate, std::uint64_t clock) {
  charge(channel, clock);
  ProcessorState& state = channel.processor;
  const auto phase = static_cast<std::uint8_t>(immediate % 64);
  if (immediate < kLeave && state.phase_depth < state.phases.size()) {
    state.phases[state.phase_depth] = phase;
    ++state.phase_depth;
    return true;
  }
  if (immediate >= kLeave && state.phase_depth != 0 && state.phases[state.phase_depth - 1] == phase) {
    --state.phase_depth;
    return true;
  }
  report_mismatch(channel, phase, clock);
  return false;
}

}  // namespace torolux
