// SPDX-License-Identifier: MIT
// Text from outside (names in files, words of a program) for a terminal: it enters, and leaves with nothing that a
// terminal would obey.
#pragma once

#include <algorithm>
#include <string>

namespace torolux {

/// Control characters but the tabulator become '?'.
inline std::string printable(std::string text) {
  const auto is_control = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20U && c != '\t') || byte == 0x7FU;
  };
  std::ranges::replace_if(text, is_control, '?');
  return text;
}

}  // namespace torolux
