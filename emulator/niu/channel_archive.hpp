// SPDX-License-Identifier: MIT
// A channel whose processor waits, to bytes and back: what a run changes of it, of its rings what they hold.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <vector>

#include "emulator/niu/channel.hpp"
#include "emulator/snapshot/archive.hpp"

namespace torolux {

inline void archive_arrivals(SnapshotWriter& archive, NiuChannel& channel) {
  std::uint64_t count = 0;
  channel.arrivals.for_each([&count](const Arrival&) { ++count; });
  archive(count);
  channel.arrivals.for_each([&](const Arrival& arrival) {
    Arrival header = arrival;
    archive(header);
    archive.append(channel.arrivals.payload(arrival));
  });
}

/// The ring is empty, and as large as the one that was saved.
inline void archive_arrivals(SnapshotReader& archive, NiuChannel& channel) {
  std::uint64_t count = 0;
  archive(count);
  std::vector<std::byte> payload;
  for (std::uint64_t i = 0; i < count; ++i) {
    Arrival header{};
    archive(header);
    if (!channel.arrivals.has_room(header.bytes)) refuse_snapshot("a PE has more arrivals than there is room for");
    payload.resize(header.bytes);
    archive.bytes(payload);
    channel.arrivals.push(header, payload);
  }
}

template <class Archive>
void archive_channel(Archive& archive, NiuChannel& channel) {
  archive(channel.bound, channel.wait, channel.clock, channel.waits, channel.copied, channel.instructions,
          channel.taken, channel.phase_cycles, channel.gather_cycles, channel.gather_records, channel.horizon,
          channel.wakes, channel.wake_time, channel.torus_departures.count, channel.torus_departures.time,
          channel.bus_departures.count, channel.bus_departures.time, channel.processor);
  archive_arrivals(archive, channel);
}

}  // namespace torolux
