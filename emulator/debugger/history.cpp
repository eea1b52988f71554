// SPDX-License-Identifier: MIT
// States lie further apart the longer the run is, so that they never take more than a bounded memory.
#include "emulator/debugger/history.hpp"

#include <algorithm>
#include <numeric>

namespace torolux::debugger {
namespace {

constexpr std::size_t kMostStates = 32;
constexpr std::size_t kMostBytes = std::size_t{512} << 20U;
/// Between two states at first: so much is run again in some ten milliseconds.
constexpr std::uint64_t kFirstInterval = 1U << 17U;

}  // namespace

std::uint64_t Position::steps() const {
  return std::accumulate(places.begin(), places.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const Place& place) { return sum + place.steps; });
}

Position position_of(const std::deque<HeldPe>& pes) {
  Position position;
  for (const HeldPe& held : pes) {
    position.places.push_back({held.steps, held.pe->standing() == DebuggedPe::Standing::waits});
  }
  return position;
}

bool is_before(const Position& earlier, const Position& later) {
  bool before = false;
  for (std::size_t i = 0; i < later.places.size(); ++i) {
    if (earlier.places[i].steps > later.places[i].steps) return false;
    before |= earlier.places[i].steps < later.places[i].steps;
  }
  return before;
}

History::History() : interval_(kFirstInterval), next_(kFirstInterval) {}

void History::plan_next() {
  next_ = (states_.empty() ? 0 : states_.back()->position.steps()) + interval_;
}

void History::keep(SavedState state) {
  bytes_ += state.bytes.size();
  states_.push_back(std::make_shared<const SavedState>(std::move(state)));
  while (states_.size() > 1 && (states_.size() > kMostStates || bytes_ > kMostBytes)) thin_out();
  plan_next();
}

/// Every second one goes; what comes will lie as far apart as those that stay.
void History::thin_out() {
  std::deque<std::shared_ptr<const SavedState>> stay;
  for (std::size_t i = 1; i < states_.size(); i += 2) stay.push_back(std::move(states_[i]));
  states_ = std::move(stay);
  interval_ *= 2;
  bytes_ = 0;
  for (const auto& state : states_) bytes_ += state->bytes.size();
}

void History::forget_behind(const Position& now, std::size_t place) {
  std::erase_if(states_, [&](const auto& state) {
    return !is_before(state->position, now) || state->position.places[place].steps == now.places[place].steps;
  });
  bytes_ = 0;
  for (const auto& state : states_) bytes_ += state->bytes.size();
  plan_next();
}

std::shared_ptr<const SavedState> History::before(const Position& end) const {
  std::shared_ptr<const SavedState> last;
  for (const auto& state : states_) {
    if (is_before(state->position, end)) last = state;
  }
  return last;
}

std::shared_ptr<const SavedState> History::before(const Position& end, std::size_t place, std::uint64_t steps) const {
  std::shared_ptr<const SavedState> last;
  for (const auto& state : states_) {
    if (is_before(state->position, end) && state->position.places[place].steps < steps) last = state;
  }
  return last;
}

}  // namespace torolux::debugger
