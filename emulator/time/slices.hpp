// SPDX-License-Identifier: MIT
// A quantity over virtual time in slices of equal width, which doubles whenever the time runs beyond the last one: so
// nobody need know beforehand how long a run is. Zeroed memory is an empty one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace torolux {

inline constexpr std::size_t kSlices = 128;
inline constexpr std::uint32_t kLeastSliceShift = 10;  ///< slices of 1024 cycles at first

/// The shift of the width at which a time lies in one of the slices.
constexpr std::uint32_t slice_shift_for(std::uint64_t time) {
  std::uint32_t shift = kLeastSliceShift;
  while (time >> shift >= kSlices) ++shift;
  return shift;
}

template <class Sum>
class Slices {
 public:
  /// A slice is 2^shift() cycles wide.
  std::uint32_t shift() const { return kLeastSliceShift + doublings_; }
  const std::array<Sum, kSlices>& sums() const { return sums_; }

  void add(std::uint64_t time, Sum amount) {
    widen(slice_shift_for(time));
    sums_[time >> shift()] += amount;
  }
  /// each: for every cycle in begin .. end - 1.
  void add_interval(std::uint64_t begin, std::uint64_t end, Sum each) {
    if (begin >= end) return;
    if ((end - 1) >> shift() >= kSlices) widen(slice_shift_for(end - 1));
    while (begin < end) {
      const std::uint64_t slice = begin >> shift();
      const std::uint64_t slice_end = (slice + 1) << shift();
      const std::uint64_t until = end < slice_end ? end : slice_end;
      sums_[slice] += static_cast<Sum>(until - begin) * each;
      begin = until;
    }
  }
  /// To slices of 2^wanted cycles, if they are not as wide already.
  void widen(std::uint32_t wanted) {
    for (; shift() < wanted; ++doublings_) {
      for (std::size_t i = 0; i < kSlices; ++i) sums_[i] = i < kSlices / 2 ? sums_[2 * i] + sums_[2 * i + 1] : Sum{};
    }
  }

 private:
  std::uint32_t doublings_;
  std::array<Sum, kSlices> sums_;
};

}  // namespace torolux
