// SPDX-License-Identifier: MIT
// The torus's routers: what comes in, who asks for what, and the slots that come back. Arbitration is in arbiter.cpp.
#include "emulator/torus/torus.hpp"

#include <algorithm>

namespace torolux {

Torus::Torus(TorusShape shape, const MachineDescription::Torus& parameters, const Jitter& jitter, EventQueue& events,
             TorusSources sources, BlockPool& pool, TorusClient& client)
    : shape_(shape),
      flit_bytes_(parameters.flit_bytes),
      buffer_(parameters.buffer_packets),
      hop_cycles_(parameters.router_cycles + parameters.link_cycles),
      slot_return_cycles_(parameters.slot_return_cycles),
      // The answer to a tail takes a way through the router and over two links: nobody sends again before.
      retry_cycles_(std::max(parameters.retry_cycles, parameters.router_cycles + 2 * parameters.link_cycles)),
      patience_(parameters.patience_cycles),
      bubble_(parameters.bubble),
      faults_(parameters),
      jitter_(jitter),
      events_(events),
      sources_(sources),
      pool_(pool),
      client_(client),
      lines_(shape, parameters.link_cycles, events, sources.routers),
      routers_(shape.routers()),
      neighbours_(shape.routers()),
      places_(shape.routers()),
      return_times_(std::size_t{shape.routers()} * kLinks * buffer_),
      may_advance_(parameters.link_error_rate == 0 && jitter.none()) {
  for (unsigned router = 0; router < shape.routers(); ++router) {
    places_[router] = shape.place(router);
    for (std::size_t port = 0; port < kLinks; ++port) {
      neighbours_[router][port] = static_cast<std::uint16_t>(shape.neighbour(router, static_cast<Port>(port)));
      routers_[router].outputs[port].slots = static_cast<std::uint16_t>(buffer_);
    }
  }
  packet_figures_.by_hops.resize(shape.diameter() + 1);
  packet_figures_.bytes_by_hops.resize(shape.diameter() + 1);
}

void Torus::handle(const Event& event) {
  switch (event.kind) {
    case EventKind::arrive:
      return arrive(event.actor, event.port, event.block, event.time);
    case EventKind::advanced:
      return end_advance(event);
    case EventKind::head: {
      const Input& input = routers_[event.actor].inputs[event.port];
      // What it was for may have been dropped; what came after that asks by itself.
      if (!input.queue.empty() && input.free_at <= event.time) {
        request(event.actor, event.port, pool_[input.queue.front()], event.time);
      }
      return;
    }
    case EventKind::tail:
      return tail(event);
    case EventKind::line:
      return line(event);
    case EventKind::arbitrate: {
      Output& output = routers_[event.actor].outputs[event.port];
      if (output.scheduled != event.time) return;  // an earlier one has been scheduled since
      output.scheduled = kNotYet;
      return arbitrate(event.actor, event.port, event.time);
    }
    default:
      return;
  }
}

// ---- Inputs ----

void Torus::inject(unsigned pe, BlockIndex block, Cycles now) {
  ++inside_;
  pool_[block].entered = now;
  pool_[block].output = static_cast<std::uint8_t>(shape_.route(places_[pe], places_[pool_[block].destination]));
  Input& input = routers_[pe].inputs[index_of(Port::local)];
  input.queue.push(pool_, block);
  input.high_water = std::max(input.high_water, input.queue.size());
  if (hop_watcher_ != nullptr) hop_watcher_->entered(pe, pool_[block]);
  if (input.queue.size() == 1) head(pe, index_of(Port::local), now);
}

void Torus::arrive(unsigned router, std::size_t port, BlockIndex block, Cycles now) {
  Input& input = routers_[router].inputs[port];
  input.queue.push(pool_, block);
  input.high_water = std::max(input.high_water, input.queue.size());
  if (input.queue.size() == 1) head(router, port, now);
}

/// The tail of a copy with a bad CRC has come. Is the copy still here, then it is dropped; else it is on its way,
/// poisoned, and will be dropped elsewhere.
void Torus::tail(const Event& event) {
  Input& input = routers_[event.actor].inputs[event.port];
  if (input.queue.back() != event.block) return;  // nothing comes behind it before its tail
  if (input.queue.size() == 1) {
    withdraw(routers_[event.actor], event.actor, event.port, input.output, event.time);
    ask(event.actor, input.output, event.time);  // nobody may be left who starves
  }
  input.queue.remove_back(pool_);
  if (pool_[event.block].copy == Copy::poisoned) free_slot(event.actor, event.port, event.time, event.time);
  pool_.give_back(event.block);
}

/// A ring's line has changed. When it falls, all who have waited too long by then raise it again at once, before they
/// can see that another has; and those who let another go first ask again.
void Torus::line(const Event& event) {
  if (lines_.handle(event)) return;
  const auto port = static_cast<Port>(event.port);
  unsigned router = event.actor;
  do {
    look_for_starving(router, event.port, event.time);
    ask(router, event.port, event.time);
    router = shape_.neighbour(router, port);
  } while (router != event.actor);
}

}  // namespace torolux
