// SPDX-License-Identifier: MIT
// Events of the machine, and the queue from which they leave in order of (time, source, sequence number).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace torolux {

using Cycles = std::uint64_t;  ///< virtual time

enum class EventKind : std::uint8_t {
  command,        ///< actor: PE, port, block: PendingCommand. It takes effect
  arrive,         ///< actor: router, port: input, block: a packet's head has come
  head,           ///< actor: router, port: input. Its next packet may ask for an output
  tail,           ///< actor: router, port: input, block: the tail of a packet with a bad CRC has come
  line,           ///< actor: first router of a ring, port: output, block: 1 raised, 0 not; all of the ring see it
  arbitrate,      ///< actor: router, port: output. Comes last in its cycle
  deliver,        ///< actor: PE, block: a packet has left the torus
  copied,         ///< actor: PE, port: 1 from the bus, block: a packet lies in its record slots
  bus_request,    ///< block: requester. The arbiter sees its request
  bus_place,      ///< the arbiter sees a freed place of the frame buffer controller
  bus_arbitrate,  ///< at the end of a cycle
  bus_done,       ///< block: a transfer has ended
  slots_asked,    ///< actor: PE, port: HostQueue. Its NIU sees that the host wants record slots
  slots_granted,  ///< actor: PE, port: HostQueue. The host sees that they are reserved
  control_free,   ///< actor: PE. The host sees that a control buffer is free
  host_queue,     ///< actor: PE or kEveryPe, block: something that the host has made is ready for the bus
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

/// A list for each of the next kWindow cycles, which is put in order when its time comes; a heap of four children per
/// node for what is later, or earlier than what has been popped. The lists' nodes are used again last in, first out, so
/// they stay in the caches.
class EventQueue {
 public:
  static constexpr Cycles kNone = ~Cycles{0};

  /// sources: actors that make events, numbered from 0.
  explicit EventQueue(std::size_t sources) : lists_(kWindow, kNobody), sequence_(sources, 0) {}

  bool empty() const { return near_ == kNone && heap_.empty(); }
  /// Of the event that comes next; kNone: there is none.
  Cycles next_time() const { return heap_.empty() || near_ < heap_.front().time ? near_ : heap_.front().time; }
  void push(Cycles time, std::uint32_t source, EventKind kind, std::uint16_t actor, std::uint8_t port,
            std::uint32_t block);
  /// Only if there is one.
  Event pop();

 private:
  static constexpr std::size_t kWindow = 1024;
  static constexpr std::size_t kWord = 64;
  static constexpr std::uint32_t kNobody = ~std::uint32_t{0};
  struct Node {
    Event event;
    std::uint32_t next;
  };

  static bool before(const Event& a, const Event& b) { return a.time != b.time ? a.time < b.time : a.order < b.order; }

  void push_open(const Event& event);
  Node& push_near(Cycles time);
  void push_far(const Event& event);
  Event pop_far();
  void open(Cycles time);
  Cycles next_near() const;

  std::vector<std::uint32_t> lists_;                     // [time % kWindow], for times from now_ to now_ + kWindow - 1
  std::array<std::uint64_t, kWindow / kWord> filled_{};  // a bit for each list that is not empty
  std::vector<Node> nodes_;                              // of lists
  std::uint32_t free_ = kNobody;                         // nodes that are of none
  Cycles now_ = 0;                                       // of the last event popped that was not from the heap alone
  Cycles near_ = kNone;                                  // earliest time with an event outside the heap
  std::vector<Event> opened_;                            // those of now_, in order, if open_
  std::size_t popped_ = 0;                               // of them, those that have gone
  bool open_ = false;
  std::vector<Event> heap_;
  std::vector<std::uint32_t> sequence_;  // per source
};

}  // namespace torolux
