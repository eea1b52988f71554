// SPDX-License-Identifier: MIT
// A channel whose processor waits, to bytes and back: what a run changes of it, of its rings what they hold. The
// commands have all been taken by then.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <vector>

#include "emulator/niu/channel.hpp"
#include "emulator/snapshot/archive.hpp"

namespace torolux {

/// As if its contents followed it, wherever they are: so it can go elsewhere.
inline Arrival with_contents_behind(const Arrival& arrival) {
  Arrival header = arrival;
  header.payload = nullptr;
  header.shared = false;
  header.lent = 0;
  header.bytes = static_cast<std::uint32_t>(contents_of(arrival).size());
  return header;
}

inline void archive_arrival(SnapshotWriter& archive, const Arrival& arrival, std::span<const std::byte> contents) {
  Arrival header = with_contents_behind(arrival);
  header.bytes = static_cast<std::uint32_t>(contents.size());
  archive(header);
  archive.append(contents);
}

inline void archive_arrivals(SnapshotWriter& archive, NiuChannel& channel) {
  std::uint64_t count = 0;
  channel.arrivals.for_each([&count](const Arrival&) { ++count; });
  archive(count);
  channel.arrivals.for_each(
      [&archive](const Arrival& arrival) { archive_arrival(archive, arrival, contents_of(arrival)); });
}

/// The ring is empty. late: called with what it has no room for, as it may be where other ranks ran the PEs.
template <class Late>
void archive_arrivals(SnapshotReader& archive, NiuChannel& channel, Late late) {
  std::uint64_t count = 0;
  archive(count);
  std::vector<std::byte> payload;
  bool has_room = true;
  for (std::uint64_t i = 0; i < count; ++i) {
    Arrival header{};
    archive(header);
    if (header.bytes > kMostBlockBytes) refuse_snapshot("an arrival is longer than any can be");
    const bool lends = channel.payloads != nullptr && header.bytes != 0;
    has_room = has_room && channel.arrivals.has_room(lends ? 0 : header.bytes);
    if (lends && has_room) {
      header.payload = channel.payloads->take_or_make();
      header.lent = static_cast<std::uint16_t>(header.bytes);
      archive.bytes(std::span(header.payload->bytes).first(header.lent));
      channel.arrivals.push(header, {});
    } else {
      payload.resize(header.bytes);
      archive.bytes(payload);
      if (has_room) {
        channel.arrivals.push(header, payload);
      } else {
        late(header, payload);
      }
    }
  }
}

/// All but the arrivals. horizon: as in the channel, where no arrivals are kept elsewhere.
template <class Archive>
void archive_channel_state(Archive& archive, NiuChannel& channel, std::atomic<std::uint64_t>& horizon) {
  archive(channel.bound, channel.wait, channel.clock, channel.waits, channel.copied, channel.instructions,
          channel.taken, channel.phase_cycles, channel.gather_cycles, channel.gather_records, horizon, channel.wakes,
          channel.wake_time, channel.torus_departures.count, channel.torus_departures.time,
          channel.bus_departures.count, channel.bus_departures.time, channel.processor);
}

}  // namespace torolux
