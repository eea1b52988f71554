// SPDX-License-Identifier: MIT
// Addresses and instructions as a person reads them: a number enters, text leaves.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace torolux {

/// All eight digits: 0xAB -> "0x000000ab".
inline std::string hexadecimal(std::uint32_t value) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "0x";
  for (unsigned shift = 32; shift != 0; shift -= 4) text += kDigits[value >> (shift - 4) & 15U];
  return text;
}

}  // namespace torolux
