// SPDX-License-Identifier: MIT
// A line of text put together without a heap: strings and numbers in, a `text` message to the host out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "firmware/niu/niu.hpp"

namespace torolux::examples {

class Text {
 public:
  Text& operator<<(std::string_view text) {
    for (const char c : text) {
      if (used_ < text_.size()) text_[used_++] = c;
    }
    return *this;
  }
  Text& operator<<(std::uint64_t number) {
    std::array<char, 20> digits{};  // of 2^64
    std::size_t first = digits.size();
    do {
      digits[--first] = static_cast<char>('0' + number % 10U);
      number /= 10U;
    } while (number != 0U);
    return *this << std::string_view(digits.data() + first, digits.size() - first);
  }

  /// `torolux run` prints it with this PE's number and clock.
  void send(pe::Niu& niu) const {
    niu.send_message(protocol::kHost, static_cast<std::uint16_t>(protocol::MachineMessage::text),
                     std::as_bytes(std::span(text_.data(), used_)));
  }

 private:
  std::array<char, 120> text_{};
  std::size_t used_ = 0;
};

}  // namespace torolux::examples
