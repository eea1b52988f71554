// SPDX-License-Identifier: MIT
// Keeps account of turns, for a scheduler that runs all PEs itself: wake-ups and runs enter, a TurnLog leaves.
#pragma once

#include <chrono>
#include <cstddef>
#include <vector>

#include "emulator/engines/engine/turn_log.hpp"

namespace torolux::translated {

/// log: filled in; null: nothing is kept.
class TurnKeeper {
 public:
  using Clock = std::chrono::steady_clock;

  TurnKeeper(TurnLog* log, std::size_t pes) : log_(log), ready_(log != nullptr ? pes : 0, 0) {}

  void begin() { begin_ = Clock::now(); }
  /// helped: spent in running PEs so far, as in what follows.
  void woken(unsigned pe, Clock::duration helped) {
    if (log_ != nullptr && ready_[pe] < 0) ready_[pe] = own(Clock::now(), helped);
  }
  /// It ran from `from` to `to`. goes_on: it could run on at once.
  void ran(unsigned pe, Clock::time_point from, Clock::time_point to, Clock::duration helped, bool goes_on) {
    if (log_ == nullptr) return;
    const double asked = own(from, helped);
    log_->turns.push_back({ready_[pe] < 0 ? asked : ready_[pe], asked, seconds(to - from), pe});
    ready_[pe] = goes_on ? asked : kWaits;
  }
  void end(Clock::duration helped) {
    if (log_ != nullptr) log_->own_seconds = own(Clock::now(), helped);
  }

 private:
  static constexpr double kWaits = -1;
  static double seconds(Clock::duration time) { return std::chrono::duration<double>(time).count(); }
  double own(Clock::time_point now, Clock::duration helped) const { return seconds(now - begin_ - helped); }

  TurnLog* log_;
  Clock::time_point begin_;
  std::vector<double> ready_;  // by PE, in the scheduler's own time; or kWaits
};

}  // namespace torolux::translated
