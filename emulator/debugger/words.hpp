// SPDX-License-Identifier: MIT
// Hexadecimal text of GDB's remote protocol: numbers and bytes in, and out. Whatever enters, nothing is thrown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace torolux::debugger {

/// Without leading zeros.
std::string hex(std::uint64_t number);
/// Two digits for each byte.
std::string hex_of(std::span<const std::byte> bytes);
std::string hex_of(std::string_view text);
/// The lowest byte first, as a register of so many bytes is sent.
std::string hex_of_register(std::uint64_t value, unsigned bytes);

/// A number of one digit at least, which is the whole text. Nothing: it is none, or does not fit.
std::optional<std::uint32_t> number_in(std::string_view text);
/// Nothing: an odd number of digits, or something else.
std::optional<std::vector<std::byte>> bytes_in(std::string_view text);
/// Four bytes, the lowest first.
std::optional<std::uint32_t> register_in(std::string_view text);

/// The text before the first `separator`, which both are taken from `text`; all of it where there is none.
std::string_view take_until(std::string_view& text, char separator);

}  // namespace torolux::debugger
