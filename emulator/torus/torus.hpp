// SPDX-License-Identifier: MIT
// The torus: packets enter at a PE's local input and leave at another's local output, in virtual time. Dimension-order
// routing, virtual cut-through, bubble flow control; docs/machine.md has the timing.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "emulator/machine/description.hpp"
#include "emulator/time/event_queue.hpp"
#include "emulator/torus/block.hpp"
#include "emulator/torus/link_faults.hpp"
#include "emulator/torus/shape.hpp"

namespace torolux {

/// What the torus asks of the NIUs.
class TorusClient {
 public:
  virtual ~TorusClient() = default;
  /// A packet has left the outgoing queue of its PE.
  virtual void injected(unsigned pe, Cycles now) = 0;
  /// May a packet leave the torus now? Then room for it is reserved. No: ask again after `Torus::try_ejection`.
  virtual bool accept(unsigned pe, BlockIndex block) = 0;
};

/// A packet of F flits that is granted an output at time g occupies it until g + F; its head is at the next router's
/// input, or its tail at the NIU F - 1 cycles later, at g + router_cycles + link_cycles. With nothing in the way a
/// packet over h links is delivered (h + 1) * (router_cycles + link_cycles) + F - 1 cycles after `inject`.
class Torus {
 public:
  /// first_source: event source of router 0; the others follow.
  Torus(TorusShape shape, const MachineDescription::Torus& parameters, std::uint32_t injected_delay, EventQueue& events,
        std::uint32_t first_source, BlockPool& pool, TorusClient& client);

  const TorusShape& shape() const { return shape_; }
  /// Flits of a packet with so many bytes of records.
  std::uint32_t flits(std::uint32_t bytes) const {
    return (bytes + kPacketHeaderBytes + flit_bytes_ - 1) / flit_bytes_;
  }
  /// Appends a packet (destination, flits, number set) to the outgoing queue of a PE. The limit on it is the NIU's.
  void inject(unsigned pe, BlockIndex block, Cycles now);
  /// The NIU has become able to accept more.
  void try_ejection(unsigned pe, Cycles now) { arbitrate(pe, index_of(Port::local), now); }
  /// Kinds arrive, head, arbitrate.
  void handle(const Event& event);

  std::uint64_t hops() const { return hops_; }  ///< links crossed by packets whose ejection has begun
  std::uint64_t link_retries() const { return faults_.retries(); }
  std::size_t packets_inside() const { return inside_; }  ///< injected, ejection not begun
  std::uint32_t queued(unsigned pe) const { return routers_[pe].inputs[index_of(Port::local)].queue.size(); }
  /// Throws MachineFailure unless on each link: free slots + slots held + slots on their way back = the buffer's.
  void check_slots() const;
  /// One line for each router that holds packets; at most `most` of them.
  std::string report(unsigned most) const;

 private:
  struct Input {
    BlockQueue queue;
    Cycles free_at = 0;       // its last packet's tail has left
    std::uint32_t held = 0;   // slots: packets granted to it and not granted onwards
    std::uint8_t output = 0;  // that the first packet asks for
  };
  struct Output {
    Cycles free_at = 0;
    Cycles scheduled = kUnscheduled;  // next arbitration
    std::uint32_t slots = 0;          // free ones at the other end, as far as known here
    std::uint8_t waiting = 0;         // inputs that ask for it, a bit each
    std::uint8_t next_input = 0;      // round robin
    std::uint32_t first_return = 0, returns = 0;
  };
  struct Router {
    std::array<Input, kPorts> inputs;
    std::array<Output, kPorts> outputs;
  };
  static constexpr Cycles kUnscheduled = ~Cycles{0};

  void request(unsigned router, std::size_t input, Cycles now);
  void arbitrate(unsigned router, std::size_t output, Cycles now);
  bool may_go(unsigned router, std::size_t input, std::size_t output);
  void grant(unsigned router, std::size_t input, std::size_t output, Cycles now);
  void free_slot(unsigned router, std::size_t input, Cycles when);
  void collect_returns(unsigned router, std::size_t output, Cycles now);
  void schedule(unsigned router, std::size_t output, Cycles when);
  Cycles& return_time(unsigned router, std::size_t output, std::uint32_t index) {
    return return_times_[(router * kLinks + output) * buffer_ + index % buffer_];
  }
  std::uint32_t source(unsigned router) const { return first_source_ + router; }

  TorusShape shape_;
  std::uint32_t flit_bytes_, buffer_, hop_cycles_, slot_return_cycles_;
  bool bubble_;
  LinkFaults faults_;
  EventQueue& events_;
  std::uint32_t first_source_;
  BlockPool& pool_;
  TorusClient& client_;
  std::vector<Router> routers_;
  std::vector<std::array<unsigned, kLinks>> neighbours_;
  std::vector<Cycles> return_times_;  // rings of buffer_ entries, one per router and link
  std::uint64_t hops_ = 0;
  std::size_t inside_ = 0;
};

}  // namespace torolux
