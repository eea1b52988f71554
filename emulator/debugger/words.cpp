// SPDX-License-Identifier: MIT
// Digits.
#include "emulator/debugger/words.hpp"

#include <charconv>

namespace torolux::debugger {
namespace {

constexpr std::string_view kDigits = "0123456789abcdef";

std::optional<unsigned> digit(char c) {
  if (c >= '0' && c <= '9') return static_cast<unsigned>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<unsigned>(c - 'a') + 10;
  if (c >= 'A' && c <= 'F') return static_cast<unsigned>(c - 'A') + 10;
  return std::nullopt;
}

}  // namespace

std::string hex(std::uint64_t number) {
  std::string text;
  do {
    text.insert(text.begin(), kDigits[number & 15U]);
    number >>= 4U;
  } while (number != 0);
  return text;
}

std::string hex_of(std::span<const std::byte> bytes) {
  std::string text;
  text.reserve(2 * bytes.size());
  for (const std::byte byte : bytes) {
    const auto value = std::to_integer<unsigned>(byte);
    text += kDigits[value >> 4U];
    text += kDigits[value & 15U];
  }
  return text;
}

std::string hex_of(std::string_view text) {
  return hex_of(std::as_bytes(std::span(text)));
}

std::string hex_of_register(std::uint64_t value, unsigned bytes) {
  std::string text;
  for (unsigned i = 0; i < bytes; ++i) {
    const auto byte = static_cast<std::byte>(value >> (8 * i) & 0xFFU);
    text += hex_of(std::span(&byte, 1));
  }
  return text;
}

std::optional<std::uint32_t> number_in(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<std::vector<std::byte>> bytes_in(std::string_view text) {
  if (text.size() % 2 != 0) return std::nullopt;
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 2);
  for (std::size_t i = 0; i < text.size(); i += 2) {
    const auto high = digit(text[i]);
    const auto low = digit(text[i + 1]);
    if (!high || !low) return std::nullopt;
    bytes.push_back(static_cast<std::byte>(*high << 4U | *low));
  }
  return bytes;
}

std::optional<std::uint32_t> register_in(std::string_view text) {
  const auto bytes = bytes_in(text);
  if (!bytes || bytes->size() != 4) return std::nullopt;
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes->size(); ++i) {
    value |= std::to_integer<std::uint32_t>((*bytes)[i]) << (8 * i);
  }
  return value;
}

std::string_view take_until(std::string_view& text, char separator) {
  const std::size_t place = text.find(separator);
  const std::string_view first = text.substr(0, place);
  text = place == std::string_view::npos ? std::string_view() : text.substr(place + 1);
  return first;
}

}  // namespace torolux::debugger
