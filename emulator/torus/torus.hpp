// SPDX-License-Identifier: MIT
// The torus: packets enter at a PE's local input and leave at another's local output, in virtual time. Dimension-order
// routing, virtual cut-through, bubble flow control; docs/machine.md has the timing.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "emulator/description/description.hpp"
#include "emulator/time/event_queue.hpp"
#include "emulator/time/jitter.hpp"
#include "emulator/torus/advance.hpp"
#include "emulator/torus/block.hpp"
#include "emulator/torus/figures.hpp"
#include "emulator/torus/hop_watcher.hpp"
#include "emulator/torus/link_faults.hpp"
#include "emulator/torus/ring_lines.hpp"
#include "emulator/torus/shape.hpp"

namespace torolux {

/// What the torus asks of the NIUs.
class TorusClient {
 public:
  virtual ~TorusClient() = default;
  /// The tail of a packet leaves the outgoing queue of its PE at `tail`, which is later than now: then its place is
  /// free.
  virtual void injected(unsigned pe, Cycles tail) = 0;
  /// May a packet leave the torus now? Then room for it is reserved. No: ask again after `Torus::try_ejection`. Asked
  /// at the end of a cycle, after all other events of it.
  virtual bool accept(unsigned pe, BlockIndex block) = 0;
  /// A packet for this PE has begun its last hop: `accept` needs not much longer. For fetching ahead alone.
  virtual void coming(unsigned /*pe*/) {}
};

/// Event sources of router 0 and of its arbiter; those of the others follow. Arbiters come after all other sources, so
/// that they see all requests of a cycle.
struct TorusSources {
  std::uint32_t routers, arbiters;
};

/// A packet of F flits that is granted an output at time g occupies it until g + F; its head is at the next router's
/// input, or its tail at the NIU F - 1 cycles later, at g + router_cycles + link_cycles. With nothing in the way a
/// packet over h links is delivered (h + 1) * (router_cycles + link_cycles) + F - 1 cycles after `inject`.
/// What is delivered may be a copy with a bad CRC (Block::copy): the client is to drop it, and what it reserved for it.
class Torus {
 public:
  Torus(TorusShape shape, const MachineDescription::Torus& parameters, const Jitter& jitter, EventQueue& events,
        TorusSources sources, BlockPool& pool, TorusClient& client);

  const TorusShape& shape() const { return shape_; }
  /// Null: nobody follows packets. Outlives this.
  void watch_hops(HopWatcher* watcher) {
    hop_watcher_ = watcher;
    if (watcher != nullptr) keep_to_time();
  }
  /// Each hop is an event from now on: for who looks at links in between. What happens at the PEs is the same.
  void keep_to_time() { may_advance_ = false; }
  /// Packets that have gone ahead of time are where they are before the arbitrations of `now`. New events may come of
  /// it, from `now` on.
  void settle(Cycles now);
  std::uint32_t flits(std::uint32_t bytes) const { return flits_of(bytes, flit_bytes_); }
  /// Appends a packet (destination, flits, number set) to the outgoing queue of a PE. The limit on it is the NIU's.
  void inject(unsigned pe, BlockIndex block, Cycles now);
  /// What the next packet of a PE, or its NIU's room, will need here, into the caches.
  void fetch_ahead(unsigned pe) const {
    __builtin_prefetch(&routers_[pe].inputs[index_of(Port::local)], 1);
    __builtin_prefetch(&routers_[pe].outputs[index_of(Port::local)], 1);
    __builtin_prefetch(&routers_[pe].injection, 1);
  }
  /// The NIU has become able to accept more.
  void try_ejection(unsigned pe, Cycles now) { ask(pe, index_of(Port::local), now); }
  /// Kinds arrive, advanced, head, tail, line, arbitrate.
  void handle(const Event& event);

  std::uint64_t link_retries() const { return faults_.retries(); }
  std::size_t packets_inside() const { return inside_; }  ///< injected, ejection not begun
  std::uint32_t queued(unsigned pe) const { return routers_[pe].inputs[index_of(Port::local)].queue.size(); }
  /// Of an outgoing link, as in LinkFigures, up to `now`.
  Cycles link_busy(unsigned router, std::size_t port, Cycles now) const {
    const Output& out = routers_[router].outputs[port];
    const Cycles ahead = out.free_at > now ? out.free_at - now : 0;
    return out.flits + routers_[router].seldom[port].busy_beyond - ahead;
  }
  /// Granted to an outgoing link so far, as in LinkFigures.
  std::uint64_t link_flits(unsigned router, std::size_t port) const { return routers_[router].outputs[port].flits; }
  /// Of each router; what lasts still counts up to `now`. Settles.
  std::vector<RouterFigures> router_figures(Cycles now);
  const PacketFigures& packet_figures() const { return packet_figures_; }
  /// Throws MachineFailure unless on each link: free slots + slots held + slots on their way back = the buffer's.
  void check_slots() const;
  /// One line for each router that holds packets; at most `most` of them.
  std::string report(unsigned most) const;
  /// All of it that a run changes.
  template <class Archive>
  void archive(Archive& archive) {
    archive(faults_, lines_, routers_, return_times_, packet_figures_, inside_, advances_);
  }

 private:
  static constexpr Cycles kNotYet = ~Cycles{0};
  static constexpr std::uint8_t kNobody = 0xFF;
  static constexpr std::uint8_t kAnyone = 0xFE;

  // What each packet changes lies in one line of the caches for each input and output; there are thousands of these.
  struct alignas(64) Input {
    BlockQueue queue;
    Cycles free_at = 0;       // its last packet's tail has left
    Cycles asked_at = 0;      // its first packet asked for an output
    std::uint8_t output = 0;  // that the first packet asks for
    std::uint32_t high_water = 0;
  };
  struct alignas(64) Output {
    Cycles free_at = 0;
    Cycles scheduled = kNotYet;   // next arbitration
    Cycles stalled_at = kNotYet;  // since when it has been free and wanted, but nothing could go
    Cycles advanced_until = 0;    // before this what a packet has made of it ahead of time may be taken back
    std::uint16_t advance = 0;    // of which
    std::uint16_t slots = 0;      // free ones at the other end, as far as known here
    std::uint16_t held = 0;       // slots there: packets granted to it and not granted onwards
    std::uint16_t may_enter = 0;
    std::uint16_t first_return = 0, returns = 0;
    std::uint8_t waiting = 0;              // inputs that ask for it, a bit each
    std::uint8_t next_input = 0;           // round robin, among packets of one age
    std::uint8_t starving = kNobody;       // the input that has waited too long to enter this ring
    std::uint64_t packets = 0, flits = 0;  // as in LinkFigures
  };
  static_assert(sizeof(Input) == 64 && sizeof(Output) == 64);
  /// Of an output's figures, what few packets change.
  struct Seldom {
    std::uint64_t wasted_flits = 0;
    Cycles stalled = 0;
    Cycles busy_beyond = 0;  // `busy` - `flits`
  };
  struct Router {
    std::array<Input, kPorts> inputs;
    std::array<Output, kPorts> outputs;
    std::array<Seldom, kPorts> seldom;
    alignas(64) LinkFigures injection;
  };

  void arrive(unsigned router, std::size_t port, BlockIndex block, Cycles now);
  void tail(const Event& event);
  void line(const Event& event);
  void head(unsigned router, std::size_t input, Cycles now);
  void request(unsigned router, std::size_t input, const Block& block, Cycles now);
  void ask(unsigned router, std::size_t output, Cycles now);
  void schedule(unsigned router, std::size_t output, Output& out, Cycles when) {
    if (out.scheduled <= when) return;
    out.scheduled = when;
    events_.push(when, sources_.arbiters + router, EventKind::arbitrate, static_cast<std::uint16_t>(router),
                 static_cast<std::uint8_t>(output), 0);
  }

  void arbitrate(unsigned router, std::size_t output, Cycles now);
  std::size_t choose(const Router& here, unsigned router, std::size_t output) const;
  bool may_go(const Output& out, unsigned router, std::size_t input, std::size_t output) const;
  void look_for_starving(unsigned router, std::size_t output, Cycles now);
  void cease_starving(unsigned router, std::size_t output, Cycles now);
  void withdraw(Router& here, unsigned router, std::size_t input, std::size_t output, Cycles now);
  void grant(Router& here, unsigned router, std::size_t input, std::size_t output, Cycles now);
  Cycles send(Output& out, unsigned router, std::size_t output, BlockIndex index, Cycles start);
  void look_ahead(unsigned next, std::size_t input, Block& block);
  bool will_go(const Output& out, std::size_t input, std::size_t output, Cycles now, Cycles time) const;
  bool advance(Output& out, unsigned router, std::size_t output, BlockIndex index, Cycles now);
  void take_back(std::uint16_t number, Cycles now);
  void end_advance(const Event& event);
  void send_copy(unsigned router, std::size_t output, BlockIndex index, Cycles start);
  void eject(Router& here, unsigned router, BlockIndex index, Cycles tail);
  void free_slot(unsigned router, std::size_t input, Cycles when, Cycles now);
  /// A packet's tail leaves the other end of an output at `when`.
  void give_back_slot(Output& out, unsigned router, std::size_t output, Cycles when) {
    --out.held;
    return_time(router, output, std::uint32_t{out.first_return} + out.returns) = when + slot_return_cycles_;
    ++out.returns;
  }
  void collect_returns(unsigned router, std::size_t output, Output& out, Cycles now) {
    while (out.returns != 0 && return_time(router, output, out.first_return) <= now) {
      ++out.slots;
      --out.returns;
      if (++out.first_return == buffer_) out.first_return = 0;
    }
  }

  /// The input whose turn it is after this one's.
  static std::uint8_t after(std::size_t input) {
    return static_cast<std::uint8_t>(input + 1 == kPorts ? 0 : input + 1);
  }
  static bool goes_on(std::size_t input, std::size_t output) {
    return static_cast<Port>(input) == opposite(static_cast<Port>(output));
  }
  /// Of inputs that wait for an output, one bit each.
  static bool anyone_enters(std::uint8_t waiting, std::size_t output) {
    return (waiting & ~(1U << opposite_link(output))) != 0;
  }
  Cycles router_delay(const Block& block) const {
    return jitter_.delay(Jitter::What::router, block.number, block.hops);
  }
  /// index: up to twice what there are, less one.
  Cycles& return_time(unsigned router, std::size_t output, std::uint32_t index) {
    return return_times_[(router * kLinks + output) * buffer_ + (index < buffer_ ? index : index - buffer_)];
  }
  std::uint32_t source(unsigned router) const { return sources_.routers + router; }

  TorusShape shape_;
  std::uint32_t flit_bytes_, buffer_, hop_cycles_, slot_return_cycles_, retry_cycles_, patience_;
  bool bubble_;
  LinkFaults faults_;
  Jitter jitter_;
  EventQueue& events_;
  TorusSources sources_;
  BlockPool& pool_;
  TorusClient& client_;
  RingLines lines_;
  std::vector<Router> routers_;
  std::vector<std::array<std::uint16_t, kLinks>> neighbours_;
  std::vector<TorusShape::Place> places_;  // of the routers
  std::vector<Cycles> return_times_;       // rings of buffer_ entries, one per router and link
  PacketFigures packet_figures_;
  std::size_t inside_ = 0;
  bool may_advance_;  // not where links fail or jitter: then no hop is sure before its time
  Advances advances_;
  HopWatcher* hop_watcher_ = nullptr;
};

// ---- What each hop does, in several files ----

/// A packet has become the first of its input. It may ask once the tail of the one before has left.
inline void Torus::head(unsigned router, std::size_t input, Cycles now) {
  const Input& in = routers_[router].inputs[input];
  const Block& block = pool_[in.queue.front()];
  const Cycles at = std::max(now, in.free_at) + router_delay(block);
  if (at == now) return request(router, input, block, now);
  events_.push(at, source(router), EventKind::head, static_cast<std::uint16_t>(router),
               static_cast<std::uint8_t>(input), 0);
}

/// The first packet of an input asks for its output.
inline void Torus::request(unsigned router, std::size_t input, const Block& block, Cycles now) {
  Router& here = routers_[router];
  Input& in = here.inputs[input];
  const std::size_t output = block.output;
  Output& out = here.outputs[output];
  if (now < out.advanced_until) take_back(out.advance, now);
  const auto bit = static_cast<std::uint8_t>(1U << input);
  if ((out.waiting & bit) != 0) return;
  in.output = static_cast<std::uint8_t>(output);
  in.asked_at = now;
  out.waiting |= bit;
  schedule(router, output, out, std::max(now, out.free_at));
}

/// An output has something to look at: at the end of this cycle, or when it is free.
inline void Torus::ask(unsigned router, std::size_t output, Cycles now) {
  Output& out = routers_[router].outputs[output];
  if (out.waiting != 0 || out.starving != kNobody) schedule(router, output, out, std::max(now, out.free_at));
}

/// The slot of a packet that has left is known to be free upstream a little later.
inline void Torus::free_slot(unsigned router, std::size_t input, Cycles when, Cycles now) {
  const unsigned upstream = neighbours_[router][input];
  const std::size_t output = opposite_link(input);
  Output& out = routers_[upstream].outputs[output];
  give_back_slot(out, upstream, output, when);
  if (out.waiting != 0) {
    schedule(upstream, output, out, std::max({now, out.free_at, return_time(upstream, output, out.first_return)}));
  }
}

/// The first packet of an input no longer asks for this output.
inline void Torus::withdraw(Router& here, unsigned router, std::size_t input, std::size_t output, Cycles now) {
  Output& out = here.outputs[output];
  out.waiting &= static_cast<std::uint8_t>(~(1U << input));
  if (out.waiting == 0 && out.stalled_at != kNotYet) {
    here.seldom[output].stalled += now - out.stalled_at;
    out.stalled_at = kNotYet;
  }
  if (out.starving == input) cease_starving(router, output, now);
}

/// The output that it will ask for at the next router, and what is needed there a few events from now, fetched into the
/// caches meanwhile.
inline void Torus::look_ahead(unsigned next, std::size_t input, Block& block) {
  const Port port = shape_.route_on(opposite(static_cast<Port>(input)), places_[next], places_[block.destination]);
  block.output = static_cast<std::uint8_t>(port);
  Router& there = routers_[next];
  __builtin_prefetch(&there.inputs[input], 1);
  __builtin_prefetch(&there.outputs[index_of(port)], 1);
  if (port == Port::local) return client_.coming(next);
  __builtin_prefetch(&return_time(next, index_of(port), 0), 1);
}

}  // namespace torolux
