// SPDX-License-Identifier: MIT
// What went over the system bus: counts by requester, by kind of traffic and by PE.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "emulator/time/event_queue.hpp"

namespace torolux {

enum class BusUser : std::uint8_t { host, queue, divert, count };  ///< queue: a PE's outgoing one
enum class BusKind : std::uint8_t {
  load,       ///< host to PE: stores
  control,    ///< host to PE: all other messages
  broadcast,  ///< host to every PE at once, whatever it says
  records,    ///< host to PE: new or diverted ones
  credits,    ///< PE to host
  answers,    ///< PE to host: all other messages
  text,       ///< PE to host
  pixels,     ///< PE to the frame buffer controller, and what the host reads from it
  diverted,   ///< divert buffer to host memory
  count
};
inline constexpr std::size_t kBusUsers = static_cast<std::size_t>(BusUser::count);
inline constexpr std::size_t kBusKinds = static_cast<std::size_t>(BusKind::count);
inline constexpr std::array<std::string_view, kBusUsers> kBusUserNames = {"host", "queues", "divert_buffers"};
inline constexpr std::array<std::string_view, kBusKinds> kBusKindNames = {
    "load", "control", "broadcast", "records", "credits", "answers", "text", "pixels", "diverted"};

struct BusTraffic {
  std::uint64_t transfers = 0;
  std::uint64_t bytes = 0;  ///< headers included
  Cycles cycles = 0;        ///< of the bus, arbitration included

  void add(std::uint64_t more_bytes, Cycles more_cycles) {
    ++transfers;
    bytes += more_bytes;
    cycles += more_cycles;
  }
};

struct BusFigures {
  Cycles arbitration_cycles = 0;
  Cycles data_cycles = 0;
  std::uint64_t transfers = 0;
  std::array<BusTraffic, kBusUsers> users;
  std::array<BusTraffic, kBusKinds> kinds;
  std::vector<BusTraffic> from_pe;  ///< its queue and its divert buffer
  std::vector<BusTraffic> to_pe;    ///< from the host, broadcasts apart

  Cycles busy_cycles() const { return arbitration_cycles + data_cycles; }
  /// For snapshots.
  template <class Archive>
  void archive(Archive& archive) {
    archive(arbitration_cycles, data_cycles, transfers, users, kinds, from_pe, to_pe);
  }
};

}  // namespace torolux
