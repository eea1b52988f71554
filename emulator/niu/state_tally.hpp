// SPDX-License-Identifier: MIT
// What somebody does over virtual time enters, as intervals one behind the other; changes of state leave, at most one
// for each grain of time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace torolux {

/// Time is cut into grains of 2^shift cycles, and each is told as one state: the one that is owed most cycles, those of
/// this grain and those that earlier grains did not tell (of several, the one with the least number). So no state is
/// told for longer or shorter than it lasted, but by a grain or two, however short its turns are; where one state lasts
/// for whole grains, these are told as they were. With a shift of 0 all is. Zeroed memory, its shift set, is one at
/// time 0.
template <std::size_t kStates>
class StateTally {
 public:
  void set_shift(std::uint32_t shift) { shift_ = shift; }
  std::uint64_t until() const { return until_; }  ///< what was before is accounted for

  /// From `until()` to `time` it was in `state`. put(begin, state): from the grain that begins there on it is in
  /// another state; false: not taken, and to be told again with the next change.
  template <class Put>
  void account(std::uint64_t time, std::size_t state, Put put) {
    if (time <= until_) return;
    const std::uint64_t grain = until_ >> shift_;
    if (time >> shift_ == grain) {
      owe(state, time - until_);
      until_ = time;
      return;
    }
    const std::uint64_t end = (grain + 1) << shift_;
    owe(state, end - until_);
    const std::size_t most = owed_most();
    tell(grain << shift_, most, put);
    owed_[most] -= std::int64_t{1} << shift_;
    const std::uint64_t last = time >> shift_ << shift_;
    if (last > end) tell(end, state, put);
    owe(state, time - last);
    until_ = time;
  }

  /// Nothing comes any more: the grain that has begun is told as it is.
  template <class Put>
  void finish(Put put) {
    const std::uint64_t begin = until_ >> shift_ << shift_;
    if (begin != until_) tell(begin, owed_most(), put);
    owed_ = {};
  }

 private:
  void owe(std::size_t state, std::uint64_t cycles) { owed_[state] += static_cast<std::int64_t>(cycles); }
  std::size_t owed_most() const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < kStates; ++i) best = owed_[i] > owed_[best] ? i : best;
    return best;
  }
  template <class Put>
  void tell(std::uint64_t begin, std::size_t state, Put put) {
    if (told_ != state + 1 && put(begin, state)) told_ = static_cast<std::uint32_t>(state + 1);
  }

  std::uint32_t shift_;
  std::uint32_t told_;                      ///< the state told last, plus one; 0: none yet
  std::uint64_t until_;                     ///< [cycles]
  std::array<std::int64_t, kStates> owed_;  ///< [cycles] by state: lasted, but not told; below 0: told in advance
};

}  // namespace torolux
