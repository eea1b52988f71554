// SPDX-License-Identifier: MIT
// Events of the machine, and the queue from which they leave in order of (time, source, sequence number).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace torolux {

using Cycles = std::uint64_t;  ///< virtual time

enum class EventKind : std::uint8_t {
  command,        ///< actor: PE. Its next command takes effect
  arrive,         ///< actor: router, port: input, block: a packet's head has come
  head,           ///< actor: router, port: input. Its next packet may ask for an output
  arbitrate,      ///< actor: router, port: output
  deliver,        ///< actor: PE, block: a packet has left the torus
  copied,         ///< actor: PE, port: 1 from the bus, block: a packet lies in its record slots
  bus_request,    ///< block: requester. The arbiter sees its request
  bus_place,      ///< the arbiter sees a freed place of the frame buffer controller
  bus_arbitrate,  ///< at the end of a cycle
  bus_done,       ///< block: a transfer has ended
  slots_asked,    ///< actor: PE, port: HostQueue. Its NIU sees that the host wants record slots
  slots_granted,  ///< actor: PE, port: HostQueue. The host sees that they are reserved
  control_free,   ///< actor: PE. The host sees that a control buffer is free
  host_queue,     ///< actor: PE, block: something that the host has made is ready for the bus
  host_step,      ///< the host takes its next message
  pixels_done,    ///< the frame buffer controller has added a message's pixels
};

struct Event {
  Cycles time;
  std::uint64_t order;  ///< source in the upper half, its sequence number in the lower
  std::uint32_t block;
  std::uint16_t actor;
  std::uint8_t port;
  EventKind kind;
};
static_assert(sizeof(Event) == 24);

/// A heap of four children per node.
class EventQueue {
 public:
  /// sources: actors that make events, numbered from 0.
  explicit EventQueue(std::size_t sources) : sequence_(sources, 0) {}

  bool empty() const { return heap_.empty(); }
  const Event& top() const { return heap_.front(); }
  void push(Cycles time, std::uint32_t source, EventKind kind, std::uint16_t actor, std::uint8_t port,
            std::uint32_t block);
  Event pop();

 private:
  static bool before(const Event& a, const Event& b) { return a.time != b.time ? a.time < b.time : a.order < b.order; }

  std::vector<Event> heap_;
  std::vector<std::uint32_t> sequence_;  // per source
};

}  // namespace torolux
