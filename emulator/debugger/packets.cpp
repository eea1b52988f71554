// SPDX-License-Identifier: MIT
// "$contents#checksum"; '}' escapes the byte behind it, which is sent with one bit changed.
#include "emulator/debugger/packets.hpp"

#include "emulator/debugger/words.hpp"

namespace torolux::debugger {
namespace {

constexpr char kInterrupt = '\x03';
constexpr char kEscape = '}';
constexpr char kEscapeBit = 0x20;
constexpr std::size_t kChecksumDigits = 2;
/// Escaped, a packet may be twice as long.
constexpr std::size_t kMostFramed = 2 * kMostPacketBytes;

std::uint8_t checksum(std::string_view bytes) {
  std::uint8_t sum = 0;
  for (const char c : bytes) sum = static_cast<std::uint8_t>(sum + static_cast<std::uint8_t>(c));
  return sum;
}

std::string without_escapes(std::string_view bytes) {
  std::string text;
  text.reserve(bytes.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const bool escaped = bytes[i] == kEscape && i + 1 < bytes.size();
    text += escaped ? static_cast<char>(bytes[++i] ^ kEscapeBit) : bytes[i];
  }
  return text;
}

}  // namespace

std::optional<PacketReader::Item> PacketReader::next() {
  using enum Item::Kind;
  while (!bytes_.empty()) {
    if (bytes_.front() == '$') return packet_at_front();
    const char first = bytes_.front();
    bytes_.erase(0, 1);
    if (first == kInterrupt) return Item{interrupt};
    if (first == '-') return Item{repeat};
  }
  return std::nullopt;
}

std::optional<PacketReader::Item> PacketReader::packet_at_front() {
  using enum Item::Kind;
  const std::size_t end = bytes_.find('#');
  if (end == std::string::npos || bytes_.size() < end + 1 + kChecksumDigits) {
    if (bytes_.size() <= kMostFramed) return std::nullopt;
    bytes_.clear();
    return Item{damaged};
  }
  const std::string framed_contents = bytes_.substr(1, end - 1);
  const auto sum = bytes_in(std::string_view(bytes_).substr(end + 1, kChecksumDigits));
  bytes_.erase(0, end + 1 + kChecksumDigits);
  if (!sum || std::to_integer<std::uint8_t>(sum->front()) != checksum(framed_contents)) return Item{damaged};
  std::string contents = without_escapes(framed_contents);
  if (contents.size() > kMostPacketBytes) return Item{damaged};
  return Item{packet, std::move(contents)};
}

std::string framed(std::string_view contents) {
  constexpr std::string_view kEscaped = "#$}*";
  std::string escaped;
  escaped.reserve(contents.size() + 4);
  for (const char c : contents) {
    if (kEscaped.find(c) == std::string_view::npos) {
      escaped += c;
    } else {
      escaped += kEscape;
      escaped += static_cast<char>(c ^ kEscapeBit);
    }
  }
  const auto sum = static_cast<std::byte>(checksum(escaped));
  return "$" + escaped + "#" + hex_of(std::span(&sum, 1));
}

}  // namespace torolux::debugger
