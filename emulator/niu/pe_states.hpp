// SPDX-License-Identifier: MIT
// What a PE may be doing, as a watcher is told: busy in a phase, or waiting for a reason.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "emulator/niu/channel.hpp"
#include "emulator/phase_names.hpp"
#include "firmware/protocol/hints.hpp"

namespace torolux {

/// Number of a state: the phase (0 .. kPhases - 1), or one of these.
using PeState = std::size_t;
inline constexpr PeState kOutsidePhases = protocol::kPhases;  ///< busy, but in no phase
inline constexpr PeState kFirstWait = kOutsidePhases + 1;     ///< and up, by WaitReason
inline constexpr PeState kIdleAtEnd = kFirstWait + kWaitReasons;
inline constexpr PeState kHalted = kIdleAtEnd + 1;
inline constexpr std::size_t kPeStates = kHalted + 1;

constexpr bool is_busy(PeState state) {
  return state <= kOutsidePhases;
}

/// As it stands in traces.
inline std::string name_of_pe_state(PeState state, const PhaseNames& phases) {
  constexpr std::array<std::string_view, kWaitReasons> kWaits = {"wait: arrivals", "wait: torus place",
                                                                 "wait: bus place", "wait: copy"};
  if (state < protocol::kPhases) return phase_name(phases, state);
  if (state == kOutsidePhases) return "no phase";
  if (state < kIdleAtEnd) return std::string(kWaits[state - kFirstWait]);
  return state == kIdleAtEnd ? "idle at the end" : "halted";
}

}  // namespace torolux
