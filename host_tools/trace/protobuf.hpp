// SPDX-License-Identifier: MIT
// Fields of a Protocol Buffers message enter; its bytes leave (protobuf.dev/programming-guides/encoding).
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace torolux {

/// One message. Fields stand in the order in which they are added; numbers are 1 and up.
class ProtoMessage {
 public:
  const std::string& bytes() const { return bytes_; }
  void clear() { bytes_.clear(); }

  /// Of the types uint32, uint64, bool and enum; int32, int64 that are not negative.
  ProtoMessage& varint(std::uint32_t field, std::uint64_t value) {
    tag(field, Wire::varint);
    raw_varint(value);
    return *this;
  }
  ProtoMessage& fixed64(std::uint32_t field, std::uint64_t value) {
    tag(field, Wire::fixed64);
    for (int shift = 0; shift < 64; shift += 8) bytes_.push_back(static_cast<char>(value >> shift & 0xFFU));
    return *this;
  }
  ProtoMessage& real(std::uint32_t field, double value) { return fixed64(field, std::bit_cast<std::uint64_t>(value)); }
  /// Also of a message within this one.
  ProtoMessage& text(std::uint32_t field, std::string_view value) {
    tag(field, Wire::length);
    raw_varint(value.size());
    bytes_.append(value);
    return *this;
  }
  ProtoMessage& message(std::uint32_t field, const ProtoMessage& value) { return text(field, value.bytes_); }

 private:
  enum class Wire : std::uint8_t { varint = 0, fixed64 = 1, length = 2 };

  void tag(std::uint32_t field, Wire wire) {
    raw_varint(std::uint64_t{field} << 3U | static_cast<std::uint64_t>(wire));
  }
  void raw_varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7U) bytes_.push_back(static_cast<char>((value & 0x7FU) | 0x80U));
    bytes_.push_back(static_cast<char>(value));
  }

  std::string bytes_;
};

}  // namespace torolux
