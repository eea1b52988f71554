// SPDX-License-Identifier: MIT
// States of the machine that a debugger may go back to. Since every run is the same, a state and the number of each
// PE's steps say all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "emulator/debugger/held_pe.hpp"

namespace torolux::debugger {

/// Where the held PEs stand: in their order.
struct Position {
  struct Place {
    std::uint64_t steps = 0;
    bool in_hint = false;  ///< the instruction that comes next is a HINT which waits
  };
  std::vector<Place> places;

  std::uint64_t steps() const;  ///< of all PEs together
};
Position position_of(const std::deque<HeldPe>& pes);
/// No PE has come further than there, and one not so far.
bool is_before(const Position& earlier, const Position& later);

/// A machine and its host's program. All edits up to each PE's steps are in it.
struct SavedState {
  Position position;
  std::uint64_t said;  ///< texts of the PEs so far
  std::vector<std::byte> bytes;
};

class History {
 public:
  History();

  /// Whether a state is wanted after so many steps of all PEs together.
  bool is_due(std::uint64_t steps) const { return steps >= next_; }
  void keep(SavedState state);
  /// The PE at this place among those that are held has been changed: what is behind `now` will not be so again, and a
  /// state that has it where it stands now lacks the change.
  void forget_behind(const Position& now, std::size_t place);

  /// The last state before `end`, which is none of the same; null: the beginning of the run.
  std::shared_ptr<const SavedState> before(const Position& end) const;
  /// Likewise, but one in which the PE at `place` has yet to come to so many steps.
  std::shared_ptr<const SavedState> before(const Position& end, std::size_t place, std::uint64_t steps) const;
  std::size_t states() const { return states_.size(); }

 private:
  void thin_out();
  void plan_next();

  std::deque<std::shared_ptr<const SavedState>> states_;  // ascending
  std::size_t bytes_ = 0;
  std::uint64_t interval_;
  std::uint64_t next_;
};

}  // namespace torolux::debugger
