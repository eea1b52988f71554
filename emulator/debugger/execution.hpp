// SPDX-License-Identifier: MIT
// Held PEs going on: whose turn it is enters; what they do leaves, and where one is to stop all of them.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "emulator/debugger/held_pe.hpp"

namespace torolux::debugger {

class Execution {
 public:
  /// numbers: of the PEs that are held, ascending.
  explicit Execution(const std::vector<unsigned>& numbers);

  /// As PeDebugger::begin.
  void begin(std::vector<std::unique_ptr<DebuggedPe>> by_number);
  void end();

  std::deque<HeldPe>& pes() { return pes_; }
  const std::deque<HeldPe>& pes() const { return pes_; }
  /// Null: it is not held.
  HeldPe* find(unsigned number);
  bool holds(unsigned number) const { return number < places_.size() && places_[number] != kNowhere; }

  /// The first action that names a PE counts; one that nobody names is held.
  void resume(const std::vector<ResumeAction>& actions);
  /// All PEs are held, and told of what this says.
  void hold(const Stop& stop);
  /// The first instruction at this cycle of its PE's clock or later stops all, once.
  void stop_at(std::optional<std::uint64_t> cycle) { last_cycle_ = cycle; }

  /// As PeDebugger::turn. A stop: nothing is to go on until it has been told.
  std::optional<Stop> turn(unsigned number, std::uint64_t until);

 private:
  static constexpr std::size_t kNowhere = ~std::size_t{0};
  std::optional<Stop> run(HeldPe& held, std::uint64_t until);
  std::optional<Stop> before(HeldPe& held);
  std::optional<Stop> run_others(const HeldPe& held);

  std::deque<HeldPe> pes_;
  std::vector<std::size_t> places_;  // in pes_, by number
  std::optional<std::uint64_t> last_cycle_;
};

/// The PE that may go on and has come least far in virtual time, the lowest of several; null: none. goes_on: asked of
/// each.
template <class GoesOn>
HeldPe* least_of(std::deque<HeldPe>& pes, GoesOn goes_on) {
  HeldPe* least = nullptr;
  for (HeldPe& held : pes) {
    if (goes_on(held) && (least == nullptr || held.pe->clock() < least->pe->clock())) least = &held;
  }
  return least;
}

}  // namespace torolux::debugger
