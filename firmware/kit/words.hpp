// SPDX-License-Identifier: MIT
// A line of text put together without a heap, for what ends a run. Enters: strings and whole numbers; leaves: bytes.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "firmware/protocol/messages.hpp"

namespace torolux::kit {

/// What does not fit is left out.
class Words {
 public:
  Words& operator<<(std::string_view text) {
    for (const char c : text) {
      if (used_ < text_.size()) text_[used_++] = c;
    }
    return *this;
  }
  template <std::integral Number>
  Words& operator<<(Number number) {
    std::uint64_t left = number < 0 ? -static_cast<std::uint64_t>(number) : static_cast<std::uint64_t>(number);
    std::array<char, 21> digits{};  // of 2^64, and a sign
    std::size_t first = digits.size();
    do {
      digits[--first] = static_cast<char>('0' + left % 10U);
      left /= 10U;
    } while (left != 0U);
    if (number < 0) digits[--first] = '-';
    return *this << std::string_view(digits.data() + first, digits.size() - first);
  }

  std::string_view text() const { return {text_.data(), used_}; }

 private:
  std::array<char, protocol::kMostFaultWords> text_{};
  std::size_t used_ = 0;
};

}  // namespace torolux::kit
