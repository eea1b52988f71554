// SPDX-License-Identifier: MIT
// Packets that nobody hinders: hops made ahead of time, without events, and taken back where somebody comes in between.
#include <algorithm>
#include <utility>

#include "emulator/torus/torus.hpp"

namespace torolux {

/// Whether a packet that comes by then is granted it at once, and when it goes (`may_go`). To enter a ring it must also
/// be sure that nobody will be seen to starve there; who begins to takes back what lies ahead.
inline bool Torus::will_go(const Output& out, std::size_t input, std::size_t output, Cycles now, Cycles time) const {
  if (out.waiting != 0 || out.starving != kNobody || out.advanced_until > now || out.free_at > time) return false;
  if (!bubble_ || goes_on(input, output)) return out.slots >= 1;
  return out.slots >= 2 && lines_.quiet();
}

/// A packet has been granted an output. As long as it finds no packet before it, and each output free, it is granted
/// these now, at the times at which it will be there. An event is made for its arrival where that ends. False: it ends
/// at the next router. Where somebody asks for one of these outputs by the time at which the packet is there or gives
/// back its slot, what lies ahead is taken back (`request`); all else that may happen meanwhile does not change what
/// the packet does.
bool Torus::advance(Output& out, unsigned router, std::size_t output, BlockIndex index, Cycles now) {
  Block& block = pool_[index];
  Output* before = &out;
  unsigned from = router;
  unsigned to = neighbours_[router][output];
  std::size_t input = opposite_link(output);
  Cycles time = now + hop_cycles_;
  std::uint16_t number = 0;
  std::uint8_t count = 0;
  while (block.output != index_of(Port::local) && before->waiting == 0 && before->held == 1 &&
         count < Advance::kMostHops) {
    const std::size_t next = block.output;
    Output& ahead = routers_[to].outputs[next];
    Input& in = routers_[to].inputs[input];
    collect_returns(to, next, ahead, now);
    if (in.free_at > time || !will_go(ahead, input, next, now, time)) break;
    if (count == 0) {
      if (advances_.full()) break;
      number = advances_.take();
    }
    advances_[number].hops[count++] = {ahead.free_at,
                                       in.free_at,
                                       static_cast<std::uint16_t>(to),
                                       static_cast<std::uint8_t>(input),
                                       block.output,
                                       ahead.next_input,
                                       in.high_water == 0};
    --ahead.slots;
    ++ahead.held;
    ++ahead.packets;
    ahead.flits += block.flits;
    ahead.next_input = after(input);
    ahead.free_at = in.free_at = time + block.flits;
    in.high_water = std::max(in.high_water, 1U);
    give_back_slot(*before, from, opposite_link(input), time + block.flits);
    before->advance = ahead.advance = number;
    before->advanced_until = ahead.advanced_until = time + 1;
    ++block.hops;
    before = &ahead;
    from = to;
    to = neighbours_[to][next];
    input = opposite_link(next);
    time += hop_cycles_;
    look_ahead(to, input, block);
  }
  if (count == 0) return false;
  Advance& made = advances_[number];
  made.block = index;
  made.count = count;
  made.first = now + hop_cycles_;
  events_.push(time, source(from), EventKind::advanced, static_cast<std::uint16_t>(to),
               static_cast<std::uint8_t>(input), number);
  return true;
}

/// What has not happened by the beginning of the arbitrations of `now`; there is some. The packet arrives at the first
/// of those routers in its time.
void Torus::take_back(std::uint16_t number, Cycles now) {
  Advance& made = advances_[number];
  Block& block = pool_[made.block];
  std::size_t left = made.count;
  Cycles time = made.first + left * hop_cycles_;
  while (left != 0 && time - hop_cycles_ >= now) {
    time -= hop_cycles_;
    const Advance::Hop& hop = made.hops[--left];
    Output& ahead = routers_[hop.router].outputs[hop.output];
    ++ahead.slots;
    --ahead.held;
    --ahead.packets;
    ahead.flits -= block.flits;
    ahead.next_input = hop.next_input;
    ahead.free_at = hop.output_free_at;
    ahead.advanced_until = 0;
    Input& in = routers_[hop.router].inputs[hop.input];
    in.free_at = hop.input_free_at;
    if (hop.input_was_unused) in.high_water = 0;
    Output& before = routers_[neighbours_[hop.router][hop.input]].outputs[opposite_link(hop.input)];
    ++before.held;
    --before.returns;
    before.advanced_until = 0;
    --block.hops;
  }
  const Advance::Hop& first = made.hops[left];
  block.output = first.output;
  events_.push(time, source(neighbours_[first.router][first.input]), EventKind::arrive, first.router, first.input,
               std::exchange(made.block, kNoBlock));
}

void Torus::settle(Cycles now) {
  for (std::size_t number = 0; number < advances_.size(); ++number) {
    const Advance& made = advances_[number];
    const Cycles last = made.first + (made.count - std::size_t{1}) * hop_cycles_;
    if (made.block != kNoBlock && last >= now) take_back(static_cast<std::uint16_t>(number), now);
  }
}

/// Its last hop ends; it arrives like any packet, unless it has been taken back.
void Torus::end_advance(const Event& event) {
  const auto number = static_cast<std::uint16_t>(event.block);
  const BlockIndex block = std::exchange(advances_[number].block, kNoBlock);
  advances_.give_back(number);
  if (block != kNoBlock) arrive(event.actor, event.port, block, event.time);
}

}  // namespace torolux
