// SPDX-License-Identifier: MIT
// As the run went forward, PEs go in the order of virtual time, but none further than it was.
#include "emulator/debugger/replay.hpp"

#include <algorithm>

namespace torolux::debugger {

std::size_t Replay::place_of(const HeldPe& held) const {
  const auto& pes = execution_.pes();
  const auto found = std::ranges::find_if(pes, [&held](const HeldPe& one) { return &one == &held; });
  return static_cast<std::size_t>(found - pes.begin());
}

bool Replay::may_step(const HeldPe& held) const {
  if (held.pe->standing() == DebuggedPe::Standing::ended) return false;
  const Position::Place& last = goal_.end.places[place_of(held)];
  return held.steps < last.steps || (held.steps == last.steps && last.in_hint);
}

bool Replay::has_arrived(const HeldPe& held) const {
  return goal_.kind == Goal::Kind::place && place_of(held) == goal_.target.place && held.steps == goal_.target.steps &&
         held.stands_between();
}

void Replay::note(const HeldPe& held, std::uint64_t clock, std::uint64_t steps, const Stop& stop) {
  if (goal_.kind != Goal::Kind::search || held.left) return;
  const std::size_t place = place_of(held);
  const Position::Place& last = goal_.end.places[place];
  if (steps > last.steps || (steps == last.steps && !last.in_hint)) return;
  const bool later = !found_ || clock > found_->clock || (clock == found_->clock && place >= found_->place);
  if (later) found_ = Found{clock, place, steps, stop};
}

void Replay::take_step(HeldPe& held) {
  make_due_edits(held);
  const std::uint64_t clock = held.pe->clock();
  const std::uint64_t steps = held.steps;
  const bool between = held.stands_between();
  if (const auto stop = stop_before(held)) note(held, clock, steps, *stop);
  const auto [how, stop] = step(held, between);
  if (how == DebuggedPe::Step::traps) {
    note(held, clock, steps, *stop);
    step(held, false);
  } else if (stop) {
    note(held, clock, steps, *stop);
  }
}

bool Replay::turn(unsigned number, std::uint64_t until) {
  HeldPe& held = *execution_.find(number);
  if (has_arrived(held)) return true;
  if (may_step(held)) {
    do {
      take_step(held);
    } while (may_step(held) && !has_arrived(held) && held.stands_between() && held.pe->clock() < until);
    return false;
  }
  // It has come as far as it was: others may have come further in virtual time, when they went on without it.
  auto& pes = execution_.pes();
  const auto goes_on = [this](const HeldPe& one) { return may_step(one) && !has_arrived(one); };
  if (HeldPe* const other = least_of(pes, [&](const HeldPe& one) { return goes_on(one) && one.stands_between(); })) {
    take_step(*other);
    return false;
  }
  for (HeldPe& other : pes) {
    const std::uint64_t steps = other.steps;
    if (!goes_on(other)) continue;
    take_step(other);
    if (other.steps != steps) return false;
  }
  return true;
}

}  // namespace torolux::debugger
