// SPDX-License-Identifier: MIT
// Numbers in, text as a person reads them out.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace torolux {

/// 1234567 -> "1 234 567".
std::string grouped(std::uint64_t value);
/// Fixed point with `digits` after the point.
std::string fixed(double value, int digits);
/// `digits` significant digits, as printf's %g.
std::string significant(double value, int digits);
/// 0.1234 -> "12.3 %".
std::string percent(double fraction, int digits = 1);
/// Bytes as "512 KiB", "1 MiB", "1.5 MiB".
std::string bytes_text(std::uint64_t bytes);
/// Wall time: "0.4 s", "12 s", "3 min 05 s", "2 h 07 min".
std::string duration(double seconds);
/// 16 digits: 0xABCD -> "0x000000000000abcd".
std::string hexadecimal(std::uint64_t value);
/// Ascending numbers: {0, 1, 2, 7} -> "0-2,7".
std::string ranges(const std::vector<unsigned>& numbers);
/// Padded with spaces in front, or behind, to `width` characters.
std::string right(const std::string& text, std::size_t width);
std::string left(const std::string& text, std::size_t width);

}  // namespace torolux
