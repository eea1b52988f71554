// SPDX-License-Identifier: MIT
// What the torus counts: for each link, and for all packets that have left it.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "emulator/torus/shape.hpp"

namespace torolux {

/// Of one output of a router, or of its local input (injection). All times in cycles.
struct LinkFigures {
  std::uint64_t packets = 0;       ///< that went on whole
  std::uint64_t flits = 0;         ///< of those
  std::uint64_t wasted_flits = 0;  ///< of copies that failed their CRC, on this link or one before
  std::uint64_t busy = 0;          ///< taken by a packet: its flits, pauses before retries, delays of jitter
  /// Free and wanted, but nothing could go: no slot at the other end; at the ejection, no room in the NIU. At the
  /// injection: the first packet waited for its output, whatever for.
  std::uint64_t stalled = 0;
  std::uint32_t queue_high_water = 0;  ///< packets at once in the input buffer at its other end (injection: before it)

  bool operator==(const LinkFigures&) const = default;
};

struct RouterFigures {
  std::array<LinkFigures, kLinks> links;  ///< that leave it, by Port
  LinkFigures injection, ejection;        ///< from and to its NIU

  bool operator==(const RouterFigures&) const = default;
};

/// Of whole packets whose ejection has begun.
struct PacketFigures {
  static constexpr std::size_t kLatencyClasses = 48;
  static constexpr std::size_t kMostRecords = 16;

  std::vector<std::uint64_t> by_hops;        ///< [h]: packets that crossed h links, up to the diameter
  std::vector<std::uint64_t> bytes_by_hops;  ///< the same in bytes of payload
  /// From entering the outgoing queue to the tail's arrival. [0]: none; [i]: 2^(i-1) to 2^i - 1 cycles.
  std::array<std::uint64_t, kLatencyClasses> by_latency{};
  std::array<std::uint64_t, kMostRecords + 1> by_records{};        ///< [n]: packets with n records
  std::array<std::uint64_t, kMostRecords + 1> bytes_by_records{};  ///< the same in bytes of payload
  std::uint64_t packets = 0;
  std::uint64_t latency_sum = 0, latency_most = 0;  ///< [cycles]
  std::uint64_t hops = 0;                           ///< links crossed
  std::uint64_t wasted_hops = 0;                    ///< links crossed by copies that failed their CRC

  void add(std::uint32_t hops_crossed, std::uint64_t latency, std::uint32_t records, std::uint32_t bytes) {
    ++packets;
    hops += hops_crossed;
    ++by_hops[hops_crossed];
    bytes_by_hops[hops_crossed] += bytes;
    latency_sum += latency;
    if (latency > latency_most) latency_most = latency;
    const auto latency_class = static_cast<std::size_t>(std::bit_width(latency));
    ++by_latency[latency_class < kLatencyClasses ? latency_class : kLatencyClasses - 1];
    const std::size_t count = records < kMostRecords ? records : kMostRecords;
    ++by_records[count];
    bytes_by_records[count] += bytes;
  }
  /// For snapshots.
  template <class Archive>
  void archive(Archive& archive) {
    archive(by_hops, bytes_by_hops, by_latency, by_records, bytes_by_records, packets, latency_sum, latency_most, hops,
            wasted_hops);
  }

  bool operator==(const PacketFigures&) const = default;
};

}  // namespace torolux
