// SPDX-License-Identifier: MIT
// Who looks into packets and messages: what they hold enters, in the same order and at the same times in every run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "emulator/time/event_queue.hpp"

namespace torolux {

/// A packet of records on its way from a PE to another.
struct RecordPacket {
  std::uint64_t number;  ///< differs from that of every other packet; the same in every run
  std::uint16_t source, destination;
  std::size_t record_bytes;
  std::span<const std::byte> records;  ///< one behind the other; valid during the call
};

/// A message over the bus, from or to a PE.
struct BusMessage {
  std::uint16_t source, destination;  ///< protocol::kHost, kFrameBuffer, kEveryPe
  std::uint16_t kind;
  std::span<const std::byte> contents;  ///< valid during the call
};

/// All times are virtual [cycles] and never fall.
class RecordWatcher {
 public:
  virtual ~RecordWatcher() = default;
  /// Into the outgoing queue of its PE.
  virtual void sent(Cycles time, const RecordPacket& packet) = 0;
  /// Into the record slots of its PE, over the bus where it was diverted.
  virtual void received(Cycles time, const RecordPacket& packet) = 0;
  /// Has come over the bus.
  virtual void came(Cycles time, const BusMessage& message) = 0;
  /// The run has come to its end; not called where it failed.
  virtual void end(Cycles time) = 0;
};

}  // namespace torolux
