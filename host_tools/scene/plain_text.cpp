// SPDX-License-Identifier: MIT
// Byte order marks, UTF-16, and what some programs leave behind the last line.
#include "host_tools/scene/plain_text.hpp"

#include <cstdint>
#include <string_view>

namespace torolux {
namespace {

void append_utf8(std::string& text, std::uint32_t code) {
  const auto byte = [&text](std::uint32_t value) { text.push_back(static_cast<char>(value)); };
  if (code < 0x80U) {
    byte(code);
  } else if (code < 0x800U) {
    byte(0xC0U | (code >> 6U));
    byte(0x80U | (code & 0x3FU));
  } else if (code < 0x1'0000U) {
    byte(0xE0U | (code >> 12U));
    byte(0x80U | ((code >> 6U) & 0x3FU));
    byte(0x80U | (code & 0x3FU));
  } else {
    byte(0xF0U | (code >> 18U));
    byte(0x80U | ((code >> 12U) & 0x3FU));
    byte(0x80U | ((code >> 6U) & 0x3FU));
    byte(0x80U | (code & 0x3FU));
  }
}

/// bytes: without the mark.
std::string from_utf16(std::string_view bytes, bool high_first, const std::string& file) {
  const auto unit = [&](std::size_t at) {
    const auto first = static_cast<unsigned char>(bytes[at]);
    const auto second = static_cast<unsigned char>(bytes[at + 1]);
    return static_cast<std::uint32_t>(high_first ? (first << 8U) | second : (second << 8U) | first);
  };
  const auto refuse_it = [&file]() {
    refuse({file}, "begins with the byte order mark of UTF-16, but is not UTF-16; save it as UTF-8");
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  if (bytes.size() % 2 != 0) refuse_it();
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    std::uint32_t code = unit(i);
    if (code >= 0xD800U && code < 0xE000U) {
      const std::uint32_t low = i + 2 < bytes.size() ? unit(i + 2) : 0;
      if (code >= 0xDC00U || low < 0xDC00U || low >= 0xE000U) refuse_it();
      code = 0x1'0000U + ((code - 0xD800U) << 10U) + (low - 0xDC00U);
      i += 2;
    }
    append_utf8(text, code);
  }
  return text;
}

}  // namespace

std::string plain_text(std::string bytes, const std::string& file, Notices& notices) {
  if (bytes.starts_with("\xEF\xBB\xBF")) {
    notices.note("a byte order mark is passed over", {file, 1});
    bytes.erase(0, 3);
  } else if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) {
    notices.note("UTF-16 is read as such, by its byte order mark", {file, 1});
    bytes = from_utf16(std::string_view(bytes).substr(2), bytes[0] == '\xFE', file);
  }
  constexpr std::string_view ending("\0\x1A", 2);
  const std::size_t end = bytes.find_last_not_of(std::string(ending) + " \t\r\n") + 1;
  if (bytes.find_first_of(ending, end) != std::string::npos) {
    notices.note("zero bytes at the end are passed over", {file});
    bytes.resize(end);
    bytes.push_back('\n');
  }
  return bytes;
}

}  // namespace torolux
