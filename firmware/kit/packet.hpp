// SPDX-License-Identifier: MIT
// How the kit's messages lie in packets of records: a head in the first record, then the message's bytes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/protocol/machine.hpp"

namespace torolux::kit {

/// Who a message is for at its receiver: the program, or the operations of all PEs together.
enum class Channel : std::uint8_t { program, together };
inline constexpr std::size_t kChannels = 2;

/// A packet that found no record slots comes later than those behind it, and from the host: so it says itself whose it
/// is, and its number.
struct PacketHead {
  std::uint16_t source;  ///< PE
  Channel channel;
  std::uint8_t unused;
  std::uint32_t number;  ///< of the packets from this source to this receiver, from 0 on, modulo 2^32
  std::uint32_t bytes;   ///< of the whole message
  std::uint32_t offset;  ///< of this packet's first byte in it
};
static_assert(sizeof(PacketHead) == 16);

/// The most bytes of a message: TOROLUX_MOST_BYTES of torolux.h.
inline constexpr std::uint32_t kMostMessage = 1U << 20U;

/// One record holds a small message; sixteen fill the largest packet.
inline constexpr std::uint32_t kRecordBytes = 64;
inline constexpr std::uint32_t kRecordsPerPacket = protocol::kMostRecordsPerPacket;
static_assert(kRecordBytes * kRecordsPerPacket == protocol::kMostPacketBytes);
/// The most bytes of a message in one packet: 1008.
inline constexpr std::uint32_t kMostPayload = kRecordBytes * kRecordsPerPacket - sizeof(PacketHead);
/// Records that the NIU fills by itself: eight of the largest packets.
inline constexpr std::uint32_t kNiuSlots = 8 * kRecordsPerPacket;
/// At the beginning of what the image leaves free: the slots of the outgoing packet, then the NIU's.
inline constexpr std::uint32_t kSlotBytes = (kRecordsPerPacket + kNiuSlots) * kRecordBytes;

constexpr std::uint32_t records_of(std::uint32_t payload) {
  return (static_cast<std::uint32_t>(sizeof(PacketHead)) + payload + kRecordBytes - 1) / kRecordBytes;
}

}  // namespace torolux::kit
