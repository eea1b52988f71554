// SPDX-License-Identifier: MIT
// The scheduler gives turns in the order of virtual time; a PE whose turn it is, and that is held, lets others go
// first.
#include "emulator/debugger/execution.hpp"

#include <algorithm>

namespace torolux::debugger {

Execution::Execution(const std::vector<unsigned>& numbers) {
  for (const unsigned number : numbers) {
    if (places_.size() <= number) places_.resize(number + 1, kNowhere);
    places_[number] = pes_.size();
    pes_.push_back({.number = number});
  }
}

void Execution::begin(std::vector<std::unique_ptr<DebuggedPe>> by_number) {
  for (HeldPe& held : pes_) held.pe = std::move(by_number.at(held.number));
}

void Execution::end() {
  for (HeldPe& held : pes_) held.pe.reset();
}

HeldPe* Execution::find(unsigned number) {
  return holds(number) ? &pes_[places_[number]] : nullptr;
}

void Execution::resume(const std::vector<ResumeAction>& actions) {
  for (HeldPe& held : pes_) {
    const auto action =
        std::ranges::find_if(actions, [&held](const ResumeAction& one) { return one.who.holds(held.number); });
    held.resumption = action != actions.end() ? action->how : Resumption{};
  }
}

void Execution::hold(const Stop& stop) {
  for (HeldPe& held : pes_) held.resumption = {};
  if (HeldPe* const held = find(stop.pe); held != nullptr && stop.is_before()) held->told_at = held->steps;
}

std::optional<Stop> Execution::turn(unsigned number, std::uint64_t until) {
  HeldPe& held = *find(number);
  return held.goes_on() ? run(held, until) : run_others(held);
}

std::optional<Stop> Execution::before(HeldPe& held) {
  make_due_edits(held);
  if (held.left || held.told_at == held.steps) return std::nullopt;
  if (held.stands_between() && last_cycle_ && held.pe->clock() >= *last_cycle_) {
    last_cycle_.reset();
    return Stop{.reason = Stop::Reason::cycle, .pe = held.number};
  }
  return stop_before(held);
}

std::optional<Stop> Execution::run(HeldPe& held, std::uint64_t until) {
  do {
    if (auto stop = before(held)) return stop;
    const auto [how, stop] = step(held, !held.left && held.told_at != held.steps);
    if (stop && !held.left) return stop;
    if (how == DebuggedPe::Step::waits) return std::nullopt;
    const Resumption& resumption = held.resumption;
    const std::uint32_t pc = held.pe->pc();
    const bool stepped =
        resumption.kind == Resumption::Kind::steps ||
        (resumption.kind == Resumption::Kind::in_range && (pc < resumption.begin || pc >= resumption.end));
    if (stepped && !held.left) return Stop{.reason = Stop::Reason::step, .pe = held.number};
    if (how == DebuggedPe::Step::ended) return std::nullopt;
  } while (held.pe->clock() < until);
  return std::nullopt;
}

/// Nothing happens in the network before `held` goes on, so the others come only as far as they need nobody.
std::optional<Stop> Execution::run_others(const HeldPe& held) {
  const auto runs = [&held](const HeldPe& other) {
    return &other != &held && other.goes_on() && other.pe->standing() != DebuggedPe::Standing::ended;
  };
  if (HeldPe* const other = least_of(pes_, [&](HeldPe& one) { return runs(one) && one.stands_between(); })) {
    return run(*other, 0);
  }
  for (HeldPe& other : pes_) {
    if (!runs(other)) continue;
    const std::uint64_t steps = other.steps;
    if (auto stop = run(other, 0)) return stop;
    if (other.steps != steps) return std::nullopt;
  }
  // Whoever should go on, but has ended, is held back as well: the run cannot end.
  const auto waits = std::ranges::find_if(pes_, [](const HeldPe& one) { return one.goes_on() && !one.left; });
  return Stop{.reason = Stop::Reason::held_back, .pe = waits != pes_.end() ? waits->number : held.number};
}

}  // namespace torolux::debugger
