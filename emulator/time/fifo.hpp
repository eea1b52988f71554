// SPDX-License-Identifier: MIT
// First in, first out, in memory that stays where it is: values enter at the back and leave at the front.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace torolux {

/// Begins again at its first byte whenever it is empty, so that thousands of short ones stay in the caches. Needs up to
/// twice the room of what is inside.
template <class T>
class Fifo {
 public:
  bool empty() const { return values_.empty(); }
  const T& front() const { return values_[first_]; }
  void push_back(const T& value) { values_.push_back(value); }
  void pop_front() {
    ++first_;
    if (2 * first_ < values_.size()) return;
    if (first_ != values_.size() && first_ < kLeastMoved) return;
    values_.erase(values_.begin(), values_.begin() + static_cast<std::ptrdiff_t>(first_));
    first_ = 0;
  }
  /// Where the next value comes to stand, into the caches.
  void fetch_ahead() const { __builtin_prefetch(values_.data() + values_.size(), 1); }
  std::size_t capacity() const { return values_.capacity(); }
  /// Oldest first.
  std::span<const T> inside() const { return std::span(values_).subspan(first_); }
  /// All of it that a run changes.
  template <class Archive>
  void archive(Archive& archive) {
    archive(values_, first_);
  }

 private:
  static constexpr std::size_t kLeastMoved = 64;

  std::vector<T> values_;
  std::size_t first_ = 0;  // of values_ that is inside
};

}  // namespace torolux
