// SPDX-License-Identifier: MIT
// A stretch of the run once more, silently: from a state to a place in the past, or to where a search ends. Turns of
// PEs enter; leaves: that it is over, and what was found.
#pragma once

#include <cstdint>
#include <optional>

#include "emulator/debugger/execution.hpp"
#include "emulator/debugger/history.hpp"

namespace torolux::debugger {

/// A place at which a run that goes back would stop: the one with the latest clock, of several that of the last PE.
struct Found {
  std::uint64_t clock;  ///< before the instruction
  std::size_t place;    ///< of the PE among those that are held
  std::uint64_t steps;
  Stop stop;
};

struct Goal {
  enum class Kind : std::uint8_t {
    search,  ///< all of it up to `end`, for the last place to stop at
    place,   ///< until the PE at `target` is about to take its next step
  };
  Kind kind;
  Position end;  ///< no PE comes further
  Found target;  ///< of `place`
};

class Replay {
 public:
  Replay(Execution& execution, Goal goal) : execution_(execution), goal_(std::move(goal)) {}

  /// As PeDebugger::turn. True: it is over.
  bool turn(unsigned number, std::uint64_t until);
  const Goal& goal() const { return goal_; }
  const std::optional<Found>& found() const { return found_; }

 private:
  bool may_step(const HeldPe& held) const;
  std::size_t place_of(const HeldPe& held) const;
  bool has_arrived(const HeldPe& held) const;
  void take_step(HeldPe& held);
  void note(const HeldPe& held, std::uint64_t clock, std::uint64_t steps, const Stop& stop);

  Execution& execution_;
  Goal goal_;
  std::optional<Found> found_;
};

}  // namespace torolux::debugger
