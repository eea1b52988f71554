// SPDX-License-Identifier: MIT
// A line of text put together without a heap: strings and numbers in, a `text` message to the host out.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

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
  /// Any whole number, in decimal.
  template <std::integral Number>
  Text& operator<<(Number number) {
    if constexpr (std::is_same_v<Number, bool>) return *this << std::string_view(number ? "true" : "false");
    if constexpr (std::is_same_v<Number, char>) return *this << std::string_view(&number, 1);
    if constexpr (std::is_signed_v<Number>) {
      if (number < 0) return write(*this << std::string_view("-"), -static_cast<std::uint64_t>(number));
    }
    return write(*this, static_cast<std::uint64_t>(number));
  }
  /// Rounded to six digits behind the point; from 2^32 on, and what is no number, by name.
  Text& operator<<(float number) {
    if (number != number) return *this << std::string_view("nan");
    const bool negative = std::signbit(number);
    if (negative) *this << std::string_view("-");
    const float size = negative ? -number : number;
    if (size >= 4294967296.0F) return *this << std::string_view(std::isinf(size) ? "inf" : "2^32 or more");
    constexpr std::uint32_t kMillion = 1'000'000;
    auto whole = static_cast<std::uint32_t>(size);
    auto millionths = static_cast<std::uint32_t>((size - static_cast<float>(whole)) * 1e6F + 0.5F);
    if (millionths == kMillion) {
      ++whole;
      millionths = 0;
    }
    *this << whole;
    if (millionths == 0) return *this;
    *this << std::string_view(".");
    for (std::uint32_t digit = kMillion / 10; digit != 0 && millionths != 0; digit /= 10) {
      *this << millionths / digit;
      millionths %= digit;
    }
    return *this;
  }
  Text& operator<<(double) = delete;  // a PE computes in single precision: write 2.5F

  /// `torolux run` prints it with this PE's number and clock.
  void send(pe::Niu& niu) const {
    niu.send_message(protocol::kHost, static_cast<std::uint16_t>(protocol::MachineMessage::text),
                     std::as_bytes(std::span(text_.data(), used_)));
  }

 private:
  static Text& write(Text& text, std::uint64_t number) {
    std::array<char, 20> digits{};  // of 2^64
    std::size_t first = digits.size();
    do {
      digits[--first] = static_cast<char>('0' + number % 10U);
      number /= 10U;
    } while (number != 0U);
    return text << std::string_view(digits.data() + first, digits.size() - first);
  }

  std::array<char, 120> text_{};
  std::size_t used_ = 0;
};

}  // namespace torolux::examples
