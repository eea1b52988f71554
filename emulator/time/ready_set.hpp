// SPDX-License-Identifier: MIT
// Who is ready, among many, for turns taken in a circle. Changes one by one, gives the next from a place on.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace torolux {

/// A bit for each member, and one for each word of bits that has any: a thousand members are two or three looks.
class ReadySet {
 public:
  static constexpr std::size_t kNobody = std::numeric_limits<std::size_t>::max();

  explicit ReadySet(std::size_t members) : bits_(words(members)), filled_(words(bits_.size())) {}

  bool has(std::size_t member) const { return (bits_[member / kWidth] >> (member % kWidth) & 1U) != 0; }
  void set(std::size_t member, bool ready) {
    const std::size_t word = member / kWidth;
    change(bits_[word], member, ready);
    change(filled_[word / kWidth], word, bits_[word] != 0);
  }
  bool empty() const { return first_from(filled_, 0) == kNobody; }
  /// The first member >= from that is ready, or else the first of all; kNobody: none is.
  std::size_t next(std::size_t from) const {
    const std::size_t found = first_at_or_after(from);
    return found != kNobody ? found : first_at_or_after(0);
  }
  /// All of it that a run changes.
  template <class Archive>
  void archive(Archive& archive) {
    archive(bits_, filled_);
  }

 private:
  using Words = std::vector<std::uint64_t>;
  static constexpr std::size_t kWidth = 64;
  static constexpr std::size_t words(std::size_t members) { return members / kWidth + 1; }

  static void change(std::uint64_t& word, std::size_t bit, bool value) {
    const std::uint64_t mask = std::uint64_t{1} << (bit % kWidth);
    word = value ? word | mask : word & ~mask;
  }
  static std::size_t first_from(const Words& words, std::size_t from) {
    std::size_t word = from / kWidth;
    if (word >= words.size()) return kNobody;
    std::uint64_t bits = words[word] & (~std::uint64_t{0} << (from % kWidth));
    while (bits == 0) {
      if (++word == words.size()) return kNobody;
      bits = words[word];
    }
    return word * kWidth + static_cast<std::size_t>(std::countr_zero(bits));
  }
  std::size_t first_at_or_after(std::size_t from) const {
    const std::size_t word = from / kWidth;
    if (word >= bits_.size()) return kNobody;
    if (const std::uint64_t bits = bits_[word] & (~std::uint64_t{0} << (from % kWidth)); bits != 0) {
      return word * kWidth + static_cast<std::size_t>(std::countr_zero(bits));
    }
    const std::size_t filled = first_from(filled_, word + 1);
    return filled == kNobody ? kNobody : filled * kWidth + static_cast<std::size_t>(std::countr_zero(bits_[filled]));
  }

  Words bits_;
  Words filled_;  // a bit for each word of bits_ that is not zero
};

}  // namespace torolux
