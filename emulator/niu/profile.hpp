// SPDX-License-Identifier: MIT
// The profile of a PE: phase markers and stages enter, busy cycles by phase leave, and marks between stages. Part of
// the processor's side of a NIU.
#pragma once

#include <cstdint>

#include "emulator/niu/channel.hpp"
#include "firmware/protocol/hints.hpp"

namespace torolux {

/// Markers do not nest as they should: a fault goes to the network side.
[[gnu::cold]] void report_mismatch(NiuChannel& channel, std::uint8_t phase, bool enters, std::uint64_t clock);

/// Charges the busy cycles since the last marker to the innermost open phase, then opens or closes one. immediate: a
/// marker's. False: report_mismatch is to be called. Firmware has a marker for each few hundred instructions.
inline bool mark_phase(NiuChannel& channel, std::int32_t immediate, std::uint64_t clock) {
  ProcessorState& state = channel.processor;
  const std::uint64_t busy = clock - state.waited;
  const std::uint32_t depth = state.phase_depth;
  const std::uint32_t innermost = depth != 0 ? state.phases[depth - 1] : protocol::kPhases;
  if (depth != 0) {
    auto& cycles = channel.phase_cycles[innermost];
    cycles.store(cycles.load(std::memory_order_relaxed) + busy - state.phase_begin, std::memory_order_relaxed);
  }
  state.phase_begin = busy;
  const std::uint32_t phase = static_cast<std::uint32_t>(immediate) % 64;
  if (immediate >= static_cast<std::int32_t>(protocol::Hint::leave_phase)) {
    if (phase != innermost) return false;
    state.phase_depth = depth - 1;
    return true;
  }
  if (depth == state.phases.size()) return false;
  state.phases[depth] = static_cast<std::uint8_t>(phase);
  state.phase_depth = depth + 1;
  return true;
}

/// All that the processor has done up to the end of the last HINT (or up to one that waits), open phases included. By
/// the processor's side, or while the processor waits.
ProcessorMark mark_of(const NiuChannel& channel);

/// The HINT that ends now, at channel.clock, has taken the first arrival of this stage.
void begin_stage(NiuChannel& channel, std::uint32_t stage);

}  // namespace torolux
