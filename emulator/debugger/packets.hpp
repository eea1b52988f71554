// SPDX-License-Identifier: MIT
// The frame of GDB's remote protocol: bytes of a connection in, packets out, and the other way. Any bytes may enter.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace torolux::debugger {

/// The longest contents that are taken, and that a debugger is told to send.
inline constexpr std::size_t kMostPacketBytes = 16384;

class PacketReader {
 public:
  struct Item {
    enum class Kind : std::uint8_t {
      packet,     ///< contents: without frame and escapes
      damaged,    ///< its checksum is wrong, or it is too long: to be sent again
      repeat,     ///< '-': the other side wants the last packet again
      interrupt,  ///< Ctrl-C
    };
    Kind kind;
    std::string contents = {};
  };

  void take(std::string_view bytes) { bytes_ += bytes; }
  /// The next item, once it is there whole.
  std::optional<Item> next();

 private:
  std::optional<Item> packet_at_front();

  std::string bytes_;
};

/// In its frame: '$', contents with escapes, '#', checksum.
std::string framed(std::string_view contents);

}  // namespace torolux::debugger
