// SPDX-License-Identifier: MIT
// What a PE may be doing, as a watcher is told: busy in a phase, or waiting for a reason.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "emulator/niu/channel.hpp"
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

/// As it stands in traces. Phases that no program of Torolux has are `phase`.
constexpr std::string_view name_of_pe_state(PeState state) {
  constexpr std::array<std::string_view, kWaitReasons> kWaits = {"wait: arrivals", "wait: torus place",
                                                                 "wait: bus place", "wait: copy"};
  if (state < static_cast<std::size_t>(protocol::Phase::count)) return protocol::kPhaseNames[state];
  if (state < protocol::kPhases) return "phase";
  if (state == kOutsidePhases) return "no phase";
  if (state < kIdleAtEnd) return kWaits[state - kFirstWait];
  return state == kIdleAtEnd ? "idle at the end" : "halted";
}

}  // namespace torolux
