// SPDX-License-Identifier: MIT
// What bounds a stage. Its figures enter; leaves: the cause, and the shares from which it follows (docs/statistics.md).
#pragma once

#include <string_view>

#include "emulator/machine/machine.hpp"
#include "host_tools/stages/rounds.hpp"

namespace torolux {

enum class Limit : std::uint8_t { work, balance, tail, waiting, bus, frame_buffer, host, link, count };
inline constexpr std::size_t kLimits = static_cast<std::size_t>(Limit::count);
inline constexpr std::array<std::string_view, kLimits> kLimitNames = {"work", "balance",      "tail", "waiting",
                                                                      "bus",  "frame_buffer", "host", "link"};

/// A part of the machine that is busy for this share of a stage or more bounds it: all PEs on average, bus, ...
inline constexpr double kSaturated = 0.8;

struct Limits {
  Limit by = Limit::work;
  /// By Limit, of the stage's length, 0..1. work + balance + waiting = 1: mean of the PEs' busy cycles, how much more
  /// the busiest PE has, and the rest. tail: ends and selections of rounds. The others: busy cycles, of the busiest
  /// link.
  std::array<double, kLimits> shares{};

  double share() const { return shares[static_cast<std::size_t>(by)]; }
};

/// rounds: of the whole run; those that begin in the stage count.
Limits limits_of(const StageFigures& stage, const std::vector<RoundFigures>& rounds);

/// As a person reads it, at most 27 characters: "host, busy for 90 %".
std::string limit_text(const Limits& limits);

}  // namespace torolux
