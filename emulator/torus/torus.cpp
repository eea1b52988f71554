// SPDX-License-Identifier: MIT
// The torus's routers: requests, arbitration, grants, and the slots that come back.
#include "emulator/torus/torus.hpp"

#include "emulator/errors.hpp"

namespace torolux {

Torus::Torus(TorusShape shape, const MachineDescription::Torus& parameters, std::uint32_t injected_delay,
             EventQueue& events, std::uint32_t first_source, BlockPool& pool, TorusClient& client)
    : shape_(shape),
      flit_bytes_(parameters.flit_bytes),
      buffer_(parameters.buffer_packets),
      hop_cycles_(parameters.router_cycles + parameters.link_cycles),
      slot_return_cycles_(parameters.slot_return_cycles),
      bubble_(parameters.bubble),
      faults_(parameters, injected_delay),
      events_(events),
      first_source_(first_source),
      pool_(pool),
      client_(client),
      routers_(shape.routers()),
      neighbours_(shape.routers()),
      return_times_(std::size_t{shape.routers()} * kLinks * buffer_) {
  for (unsigned router = 0; router < shape.routers(); ++router) {
    for (std::size_t port = 0; port < kLinks; ++port) {
      neighbours_[router][port] = shape.neighbour(router, static_cast<Port>(port));
      routers_[router].outputs[port].slots = buffer_;
    }
  }
}

void Torus::inject(unsigned pe, BlockIndex block, Cycles now) {
  ++inside_;
  Input& input = routers_[pe].inputs[index_of(Port::local)];
  const bool first = input.queue.empty();
  input.queue.push(pool_, block);
  if (!first) return;
  if (input.free_at > now) {
    events_.push(input.free_at, source(pe), EventKind::head, static_cast<std::uint16_t>(pe),
                 static_cast<std::uint8_t>(Port::local), 0);
  } else {
    request(pe, index_of(Port::local), now);
  }
}

void Torus::handle(const Event& event) {
  Router& router = routers_[event.actor];
  switch (event.kind) {
    case EventKind::arrive: {
      Input& input = router.inputs[event.port];
      const bool first = input.queue.empty();
      input.queue.push(pool_, event.block);
      if (!first) break;
      if (input.free_at > event.time) {
        events_.push(input.free_at, source(event.actor), EventKind::head, event.actor, event.port, 0);
      } else {
        request(event.actor, event.port, event.time);
      }
      break;
    }
    case EventKind::head:
      request(event.actor, event.port, event.time);
      break;
    case EventKind::arbitrate:
      if (router.outputs[event.port].scheduled != event.time) break;  // an earlier one has been scheduled since
      router.outputs[event.port].scheduled = kUnscheduled;
      arbitrate(event.actor, event.port, event.time);
      break;
    default:
      break;
  }
}

/// The first packet of an input asks for its output.
void Torus::request(unsigned router, std::size_t input, Cycles now) {
  Input& in = routers_[router].inputs[input];
  const auto output = index_of(shape_.route(router, pool_[in.queue.front()].destination));
  in.output = static_cast<std::uint8_t>(output);
  routers_[router].outputs[output].waiting |= static_cast<std::uint8_t>(1U << input);
  arbitrate(router, output, now);
}

void Torus::schedule(unsigned router, std::size_t output, Cycles when) {
  Output& out = routers_[router].outputs[output];
  if (out.scheduled <= when) return;
  out.scheduled = when;
  events_.push(when, source(router), EventKind::arbitrate, static_cast<std::uint16_t>(router),
               static_cast<std::uint8_t>(output), 0);
}

void Torus::collect_returns(unsigned router, std::size_t output, Cycles now) {
  Output& out = routers_[router].outputs[output];
  while (out.returns != 0 && return_time(router, output, out.first_return) <= now) {
    ++out.slots;
    --out.returns;
    out.first_return = (out.first_return + 1) % buffer_;
  }
}

/// Bubble flow control: to enter a ring leaves at least one of its buffers' slots free, to go on needs one.
/// At the local output the NIU decides.
bool Torus::may_go(unsigned router, std::size_t input, std::size_t output) {
  if (output == index_of(Port::local)) return client_.accept(router, routers_[router].inputs[input].queue.front());
  const bool goes_on = static_cast<Port>(input) == opposite(static_cast<Port>(output));
  return routers_[router].outputs[output].slots >= (goes_on || !bubble_ ? 1U : 2U);
}

void Torus::arbitrate(unsigned router, std::size_t output, Cycles now) {
  Output& out = routers_[router].outputs[output];
  if (out.waiting == 0) return;
  if (out.free_at > now) return schedule(router, output, out.free_at);
  const bool local = output == index_of(Port::local);
  if (!local) collect_returns(router, output, now);
  for (std::size_t i = 0; i < kPorts; ++i) {
    const std::size_t input = (out.next_input + i) % kPorts;
    if ((out.waiting >> input & 1U) == 0) continue;
    if (may_go(router, input, output)) {
      grant(router, input, output, now);
      if (out.waiting != 0) schedule(router, output, out.free_at);
      return;
    }
    if (local) return;  // the NIU takes packets in the order of the round: a small one does not overtake
  }
  if (out.returns != 0) schedule(router, output, return_time(router, output, out.first_return));
}

void Torus::grant(unsigned router, std::size_t input, std::size_t output, Cycles now) {
  Input& in = routers_[router].inputs[input];
  Output& out = routers_[router].outputs[output];
  const BlockIndex index = in.queue.pop(pool_);
  Block& block = pool_[index];
  const bool local = output == index_of(Port::local);
  const Cycles lost = local || faults_.none() ? 0 : faults_.cycles_lost(block);
  const Cycles tail = now + lost + block.flits;
  out.waiting &= static_cast<std::uint8_t>(~(1U << input));
  out.next_input = static_cast<std::uint8_t>((input + 1) % kPorts);
  out.free_at = in.free_at = tail;
  if (local) {
    --inside_;
    hops_ += block.hops;
    events_.push(tail - 1 + hop_cycles_, source(router), EventKind::deliver, static_cast<std::uint16_t>(router), 0,
                 index);
  } else {
    const unsigned next = neighbours_[router][output];
    const std::size_t port = index_of(opposite(static_cast<Port>(output)));
    --out.slots;
    ++block.hops;
    ++routers_[next].inputs[port].held;
    events_.push(now + lost + hop_cycles_, source(router), EventKind::arrive, static_cast<std::uint16_t>(next),
                 static_cast<std::uint8_t>(port), index);
  }
  if (!in.queue.empty()) {
    events_.push(tail, source(router), EventKind::head, static_cast<std::uint16_t>(router),
                 static_cast<std::uint8_t>(input), 0);
  }
  if (input == index_of(Port::local)) {
    client_.injected(router, now);
  } else {
    free_slot(router, input, tail);
  }
}

/// The slot of a packet that has left is known to be free upstream a little later.
void Torus::free_slot(unsigned router, std::size_t input, Cycles when) {
  --routers_[router].inputs[input].held;
  const unsigned upstream = neighbours_[router][input];
  const std::size_t output = index_of(opposite(static_cast<Port>(input)));
  Output& out = routers_[upstream].outputs[output];
  const Cycles known = when + slot_return_cycles_;
  return_time(upstream, output, out.first_return + out.returns) = known;
  ++out.returns;
  if (out.waiting != 0) {
    schedule(upstream, output, std::max(out.free_at, return_time(upstream, output, out.first_return)));
  }
}

void Torus::check_slots() const {
  for (unsigned router = 0; router < shape_.routers(); ++router) {
    for (std::size_t port = 0; port < kLinks; ++port) {
      const Output& out = routers_[router].outputs[port];
      const std::size_t at = index_of(opposite(static_cast<Port>(port)));
      const std::uint32_t held = routers_[neighbours_[router][port]].inputs[at].held;
      if (out.slots + out.returns + held != buffer_) {
        throw MachineFailure("router " + std::to_string(router) + ", link " + std::to_string(port) + ": " +
                             std::to_string(out.slots) + " slots free, " + std::to_string(out.returns) +
                             " on their way back, " + std::to_string(held) + " held; the buffer has " +
                             std::to_string(buffer_));
      }
    }
  }
}

std::string Torus::report(unsigned most) const {
  constexpr std::array<const char*, kPorts> kNames = {"east", "west", "south", "north", "local"};
  std::string text;
  for (unsigned router = 0; router < shape_.routers() && most != 0; ++router) {
    std::string line;
    for (std::size_t port = 0; port < kPorts; ++port) {
      const Input& input = routers_[router].inputs[port];
      if (input.queue.empty()) continue;
      line += std::string(", ") + std::to_string(input.queue.size()) + " from " + kNames[port] + " for " +
              kNames[input.output];
      const Output& out = routers_[router].outputs[input.output];
      if (input.output != index_of(Port::local)) line += " (" + std::to_string(out.slots) + " slots free)";
    }
    if (line.empty()) continue;
    text += "  router " + std::to_string(router) + ": packets wait" + line + "\n";
    --most;
  }
  return text;
}

}  // namespace torolux
