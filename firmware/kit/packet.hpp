// SPDX-License-Identifier: MIT
// How the kit's messages lie in packets of records: a head in the first record, then the message's bytes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/kit/call.hpp"
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
  std::uint8_t lead;     ///< bytes of the message behind this head in its record, 0..kMostLead; then whole records
  std::uint32_t number;  ///< of the packets from this source to this receiver, from 0 on, modulo 2^32
  std::uint32_t left;    ///< bytes of the message from this packet on: in its first, of the whole
  Call call;             ///< what the message belongs to; means nothing in Channel::program
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
inline constexpr std::uint32_t kMostLead = kRecordBytes - sizeof(PacketHead);

constexpr std::uint32_t records_of(std::uint32_t payload) {
  return (static_cast<std::uint32_t>(sizeof(PacketHead)) + payload + kRecordBytes - 1) / kRecordBytes;
}

/// Where record slots lie. The program's own cover local memory up to the NIU's, as far as slots have numbers: so what
/// is sent need not be copied first. The last of them, `staging`, hold heads, and what cannot be sent from its place.
struct SlotLayout {
  static constexpr std::uint32_t kMostSlots = 65534;    // of all, as the NIU numbers them
  static constexpr std::uint32_t kMostNiuSlots = 4096;  // likewise
  /// Of local memory, one part in so many takes what arrives: what finds no room there comes later, by way of the host.
  static constexpr std::uint32_t kPartForArrivals = 8;
  static constexpr std::uint32_t kStagingBytes = kRecordsPerPacket * kRecordBytes;

  std::uint32_t first;    ///< address of slot 0
  std::uint32_t own;      ///< slots of the program
  std::uint32_t niu;      ///< slots of the NIU behind them
  std::uint32_t staging;  ///< address of the first of kRecordsPerPacket: memory is the heap's up to here
};

constexpr SlotLayout slot_layout(std::uint32_t memory_begin, std::uint32_t memory_end) {
  const std::uint32_t wanted = (memory_end - memory_begin) / SlotLayout::kPartForArrivals / kRecordBytes;
  const std::uint32_t niu = wanted < SlotLayout::kMostNiuSlots ? wanted : SlotLayout::kMostNiuSlots;
  const std::uint32_t niu_begin = memory_end - niu * kRecordBytes;
  const std::uint32_t all = (niu_begin - memory_begin) / kRecordBytes;
  const std::uint32_t own = all + niu < SlotLayout::kMostSlots ? all : SlotLayout::kMostSlots - niu;
  return {niu_begin - own * kRecordBytes, own, niu, niu_begin - SlotLayout::kStagingBytes};
}
static_assert(
    slot_layout(protocol::kLocalMemoryBase, protocol::kLocalMemoryBase + protocol::kSmallestLocalMemory).niu == 512);
static_assert(slot_layout(protocol::kLocalMemoryBase, protocol::kLocalMemoryBase + protocol::kLargestLocalMemory).niu ==
              SlotLayout::kMostNiuSlots);

}  // namespace torolux::kit
