// SPDX-License-Identifier: MIT
// The lower bounds of all PEs: before which time no PE will do anything more. Changes one by one, gives the least.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace torolux {

/// A tournament over the bounds; equal ones: the lowest PE.
class BoundTree {
 public:
  BoundTree(std::size_t count, std::uint64_t value)
      : count_(count),
        leaves_(std::bit_ceil(std::max<std::size_t>(count, 1))),
        bound_(leaves_, std::numeric_limits<std::uint64_t>::max()),
        winner_(2 * leaves_) {
    std::fill_n(bound_.begin(), count, value);
    for (std::size_t i = 0; i < leaves_; ++i) winner_[leaves_ + i] = static_cast<std::uint32_t>(i);
    for (std::size_t i = leaves_ - 1; i >= 1; --i) play(i);
  }

  std::uint64_t at(std::size_t index) const { return bound_[index]; }
  std::uint64_t least() const { return bound_[winner_[1]]; }
  std::size_t least_index() const { return winner_[1]; }
  /// Of the least bound but one: the best of those whom the winner has beaten. With one PE alone: that.
  std::size_t second_index() const {
    std::size_t best = winner_[1];
    for (std::size_t i = leaves_ + winner_[1]; i > 1; i /= 2) {
      const std::size_t beaten = winner_[i ^ 1U];
      if (beaten >= count_) continue;
      if (best == winner_[1] || bound_[beaten] < bound_[best]) best = beaten;
    }
    return best;
  }
  void set(std::size_t index, std::uint64_t value) {
    bound_[index] = value;
    for (std::size_t i = (leaves_ + index) / 2; i >= 1; i /= 2) {
      const std::uint32_t before = winner_[i];
      play(i);
      // The game above was, and is, played by another, whose bound is what it was.
      if (winner_[i] == before && before != index) return;
    }
  }
  /// All of it that a run changes.
  template <class Archive>
  void archive(Archive& archive) {
    archive(bound_, winner_);
  }

 private:
  void play(std::size_t node) {
    const std::uint32_t left = winner_[2 * node];
    const std::uint32_t right = winner_[2 * node + 1];
    winner_[node] = bound_[right] < bound_[left] ? right : left;
  }

  std::size_t count_;
  std::size_t leaves_;
  std::vector<std::uint64_t> bound_;
  std::vector<std::uint32_t> winner_;  // node 1 is the root; children of n: 2n, 2n + 1
};

}  // namespace torolux
