// SPDX-License-Identifier: MIT
// Arbitration: the requests of a cycle in, one packet for each free output on its way.
#include <algorithm>
#include <bit>

#include "emulator/torus/torus.hpp"

namespace torolux {

void Torus::arbitrate(unsigned router, std::size_t output, Cycles now) {
  Router& here = routers_[router];
  Output& out = here.outputs[output];
  if (out.starving == kAnyone && !anyone_enters(out.waiting, output)) cease_starving(router, output, now);
  if (out.waiting == 0) return;
  if (out.free_at > now) return schedule(router, output, out, out.free_at);
  const bool local = output == index_of(Port::local);
  if (!local) collect_returns(router, output, out, now);
  std::size_t input = choose(here, router, output);
  // The NIU takes packets in the order of their ages: a small one does not overtake.
  if (local && !client_.accept(router, here.inputs[input].queue.front())) input = kNobody;
  if (input != kNobody) grant(here, router, input, output, now);
  if (!local && out.waiting != 0) look_for_starving(router, output, now);
  if (input != kNobody) {
    if (out.waiting != 0 || out.starving != kNobody) schedule(router, output, out, out.free_at);
    return;
  }
  if (out.stalled_at == kNotYet) out.stalled_at = now;
  if (out.returns != 0) schedule(router, output, out, return_time(router, output, out.first_return));
}

/// The oldest packet of those that may go; equal ones in turn. kNobody: none may.
inline std::size_t Torus::choose(const Router& here, unsigned router, std::size_t output) const {
  const Output& out = here.outputs[output];
  // Not has_single_bit, which counts bits: a call, where the computer is not known to have an instruction for it.
  if ((out.waiting & (out.waiting - 1U)) == 0) {
    const auto input = static_cast<std::size_t>(std::countr_zero(std::uint32_t{out.waiting}));
    return may_go(out, router, input, output) ? input : kNobody;
  }
  std::size_t best = kNobody;
  Cycles oldest = kNotYet;
  for (std::size_t i = 0; i < kPorts; ++i) {
    const std::size_t input = out.next_input + i < kPorts ? out.next_input + i : out.next_input + i - kPorts;
    if ((out.waiting >> input & 1U) == 0 || !may_go(out, router, input, output)) continue;
    const Cycles entered = pool_[here.inputs[input].queue.front()].entered;
    if (best != kNobody && entered >= oldest) continue;
    best = input;
    oldest = entered;
  }
  return best;
}

/// Bubble flow control: to enter a ring leaves at least one of its buffers' slots free, to go on needs one. Who enters
/// lets those go first who starve; who goes on waits for nobody. At the local output the NIU decides.
inline bool Torus::may_go(const Output& out, unsigned router, std::size_t input, std::size_t output) const {
  if (output == index_of(Port::local)) return true;
  if (!bubble_ || goes_on(input, output)) return out.slots >= 1;
  if (out.slots < 2) return false;
  if (out.starving == kNobody) return !lines_.seen(router, static_cast<Port>(output));
  return out.starving == input || out.starving == kAnyone;
}

/// Whoever has waited too long to enter a ring raises its line; of several the one that has waited longest. Not while
/// the line is seen to be raised: so nobody is served twice before the others have been.
void Torus::look_for_starving(unsigned router, std::size_t output, Cycles now) {
  Router& here = routers_[router];
  Output& out = here.outputs[output];
  if (!bubble_ || out.starving != kNobody || lines_.seen(router, static_cast<Port>(output))) return;
  Cycles oldest = kNotYet;
  for (std::size_t input = 0; input < kPorts; ++input) {
    const Input& in = here.inputs[input];
    if ((out.waiting >> input & 1U) == 0 || goes_on(input, output) || now - in.asked_at <= patience_) continue;
    const Cycles entered = pool_[in.queue.front()].entered;
    if (entered >= oldest) continue;
    oldest = entered;
    out.starving = static_cast<std::uint8_t>(input);
  }
  if (out.starving == kNobody) return;
  out.may_enter = static_cast<std::uint16_t>(buffer_);
  lines_.begin(router, static_cast<Port>(output), now);
  settle(now);  // who goes ahead into a ring may be held back by then
}

void Torus::cease_starving(unsigned router, std::size_t output, Cycles now) {
  routers_[router].outputs[output].starving = kNobody;
  lines_.end(router, static_cast<Port>(output), now);
}

void Torus::grant(Router& here, unsigned router, std::size_t input, std::size_t output, Cycles now) {
  Input& in = here.inputs[input];
  Output& out = here.outputs[output];
  const BlockIndex index = in.queue.front();
  const Block& block = pool_[index];
  in.queue.pop(block);
  const bool in_slot_of_good_copy = block.copy == Copy::bad;
  const bool local = output == index_of(Port::local);
  const Cycles start = now + (local ? 0 : jitter_.delay(Jitter::What::link, block.number, block.hops));
  const std::uint32_t flits = block.flits;
  const Cycles tail = start + flits;
  if (out.starving != kNobody && !goes_on(input, output)) {
    out.starving = kAnyone;
    if (--out.may_enter == 0) cease_starving(router, output, now);
  }
  withdraw(here, router, input, output, now);
  if (out.stalled_at != kNotYet) here.seldom[output].stalled += now - out.stalled_at;
  out.stalled_at = kNotYet;
  out.next_input = after(input);
  in.free_at = tail;
  if (input == index_of(Port::local)) {
    LinkFigures& figures = here.injection;
    ++figures.packets;
    figures.flits += flits;
    figures.busy += tail - now;
    figures.stalled += now - in.asked_at;
  }
  if (local) {
    eject(here, router, index, tail);
    out.free_at = tail;
  } else {
    out.free_at = send(out, router, output, index, start);
  }
  const Cycles beyond = out.free_at - now - (block.copy == Copy::good ? flits : 0);
  if (beyond != 0) here.seldom[output].busy_beyond += beyond;
  if (!in.queue.empty()) head(router, input, now);
  if (input == index_of(Port::local)) {
    client_.injected(router, tail);
  } else if (!in_slot_of_good_copy) {
    free_slot(router, input, tail, now);
  }
}

/// Over a link, again and again until a copy arrives whole. Returns when the output is free. The link's sender keeps
/// what it has sent until the answer comes (docs/machine.md), so the input and its slot are free after the first tail.
inline Cycles Torus::send(Output& out, unsigned router, std::size_t output, BlockIndex index, Cycles start) {
  Block& block = pool_[index];
  const unsigned next = neighbours_[router][output];
  const std::size_t input = opposite_link(output);
  --out.slots;
  ++out.held;
  look_ahead(next, input, block);
  if (block.copy != Copy::good) {
    block.copy = Copy::poisoned;
    ++block.hops;
    send_copy(router, output, index, start);
    return start + block.flits;
  }
  const std::uint32_t bad = faults_.bad_copies(block);
  ++block.hops;
  for (std::uint32_t i = 0; i < bad; ++i) {
    const BlockIndex copy = pool_.take();
    pool_[copy].become_bad_copy_of(block);
    send_copy(router, output, copy, start);
    start += block.flits + retry_cycles_;
  }
  ++out.packets;
  out.flits += block.flits;
  if (hop_watcher_ != nullptr) hop_watcher_->leaves(router, output, block, start, start + hop_cycles_);
  if (may_advance_ && advance(out, router, output, index, start)) return start + block.flits;
  events_.push(start + hop_cycles_, source(router), EventKind::arrive, static_cast<std::uint16_t>(next),
               static_cast<std::uint8_t>(input), index);
  return start + block.flits;
}

/// A copy that is not good: at the other end its head goes on like any, until its tail shows what it is.
void Torus::send_copy(unsigned router, std::size_t output, BlockIndex index, Cycles start) {
  const Block& block = pool_[index];
  const auto next = static_cast<std::uint16_t>(neighbours_[router][output]);
  const auto port = static_cast<std::uint8_t>(opposite(static_cast<Port>(output)));
  ++packet_figures_.wasted_hops;
  routers_[router].seldom[output].wasted_flits += block.flits;
  events_.push(start + hop_cycles_, source(router), EventKind::arrive, next, port, index);
  events_.push(start + hop_cycles_ + block.flits - 1, source(router), EventKind::tail, next, port, index);
}

void Torus::eject(Router& here, unsigned router, BlockIndex index, Cycles tail) {
  const Block& block = pool_[index];
  const Cycles delivered = tail - 1 + hop_cycles_;
  Output& out = here.outputs[index_of(Port::local)];
  if (block.copy == Copy::good) {
    --inside_;
    packet_figures_.add(block.hops, delivered - block.entered, block.records, block.bytes);
    ++out.packets;
    out.flits += block.flits;
    if (hop_watcher_ != nullptr) {
      hop_watcher_->leaves(router, index_of(Port::local), block, tail - block.flits, delivered);
    }
  } else {
    here.seldom[index_of(Port::local)].wasted_flits += block.flits;
  }
  events_.push(delivered, source(router), EventKind::deliver, static_cast<std::uint16_t>(router), 0, index);
}

}  // namespace torolux
