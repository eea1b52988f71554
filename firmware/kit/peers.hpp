// SPDX-License-Identifier: MIT
// What a PE keeps of those that it exchanges messages with. Enters: a PE's number; leaves: its entry. Entries are made
// in groups when the first of them is needed, so a machine of thousands of PEs costs little.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "firmware/kit/block.hpp"
#include "firmware/kit/packet.hpp"

namespace torolux::kit {

/// A message on the heap, its bytes behind it.
struct Waiting {
  Block<Waiting> next;
  std::uint32_t bytes;
  std::uint16_t source;
  Channel channel;
  Call call;
};

/// A packet that came before others of its sender; its bytes of the message behind it.
struct Early {
  Block<Early> next;
  PacketHead head;
  std::uint32_t payload;  ///< [bytes]
};

struct Peer {
  std::uint32_t sent;   ///< packets to it
  std::uint32_t taken;  ///< packets from it, in order
  std::byte* into;      ///< where the message goes of which packets are still to come; null: there is none
  Block<Waiting> open;  ///< that message, where it lies on the heap
  Block<Early> early;   ///< by their numbers
};

class Peers {
 public:
  static constexpr std::uint32_t kGroup = 32;

  /// False: no memory for the table.
  bool begin(std::uint32_t pes);
  /// Null: no memory.
  Peer* of(std::uint32_t pe);

 private:
  using Group = std::array<Peer, kGroup>;
  std::unique_ptr<Block<Group>[]> groups_;
};

}  // namespace torolux::kit
