// SPDX-License-Identifier: MIT
// Arrivals for one PE, on its rank: words of the network and payloads from other ranks enter in any order; arrivals
// leave into the PE's ring in the order of the words, and wake-ups and the horizon behind them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <unordered_map>
#include <vector>

#include "emulator/niu/channel.hpp"
#include "emulator/remote/wire.hpp"
#include "emulator/snapshot/archive.hpp"

namespace torolux::remote {

/// For one thread, beside the processor's.
class ArrivalLine {
 public:
  /// channel: set up; number: of the PE.
  ArrivalLine(NiuChannel& channel, unsigned number) : channel_(&channel), number_(number) {}

  /// words: of this PE; rest: behind the times of departures. Throws MachineFailure where they cannot be.
  void take(const Words& words, ByteReader& rest);
  /// A payload of a packet for this PE. It stays here until a word has named it.
  void keep(const PacketName& name, std::span<const std::byte> payload);
  /// What waited goes on, as far as there is room and payloads have come. True: something has.
  bool refill();

  /// What stands in front waits for: the payload of that packet.
  std::optional<PacketName> awaited() const;
  /// What waits at all.
  bool waits() const { return !late_.empty(); }

  // ---- While nobody runs the PE ----

  /// The first of all payloads that words have named and that have not come.
  std::optional<PacketName> missing() const;
  bool has(const PacketName& name) const { return kept_.contains(key(name)); }
  /// Which it keeps no longer. Throws MachineFailure where it does not.
  std::vector<std::byte> give(const PacketName& name);
  /// Payloads that no word has named.
  std::size_t unnamed() const;
  std::uint64_t horizon() const { return horizon_; }
  /// As archive_arrivals: those in the ring, and those behind them.
  void save(SnapshotWriter& archive) const;
  /// The channel is as a saved run has left it, without arrivals.
  void restored() { pushed_ = channel_->taken.load(std::memory_order_relaxed); }

 private:
  struct Late {
    Arrival arrival;                 // as if its payload followed it
    std::optional<PacketName> name;  // of a payload that comes, or has come, another way
    std::vector<std::byte> payload;  // else
  };
  static std::uint64_t key(const PacketName& name) { return (std::uint64_t{name.source} << 48U) | name.number; }
  Late next_of(ByteReader& rest) const;
  bool push(const Late& late);
  void publish();

  NiuChannel* channel_;
  unsigned number_;
  std::uint64_t pushed_ = 0;  // arrivals, so far
  std::uint64_t horizon_ = 0, wakes_ = 0, wake_time_ = 0;
  // No more than the NIU has slots and buffers.
  std::deque<Late> late_;
  // By source and number: of packets that are in the network, or in late_.
  std::unordered_map<std::uint64_t, std::vector<std::byte>> kept_;
};

}  // namespace torolux::remote
