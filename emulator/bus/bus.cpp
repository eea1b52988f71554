// SPDX-License-Identifier: MIT
// The system bus: requests as the arbiter sees them, arbitration in turn, the time of a transfer, and the counts.
#include "emulator/bus/bus.hpp"

#include "firmware/protocol/messages.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {

namespace {

BusUser user_of(BusRequester requester) {
  if (requester.is_host()) return BusUser::host;
  return requester.is_divert() ? BusUser::divert : BusUser::queue;
}

BusKind kind_of(BusRequester requester, const Block& block) {
  const auto is = [&block](auto kind) { return block.message_kind == static_cast<std::uint16_t>(kind); };
  if (requester.is_divert()) return BusKind::diverted;
  if (block.records != 0) return BusKind::records;
  if (block.is_broadcast()) return BusKind::broadcast;
  if (block.destination == protocol::kFrameBuffer) return BusKind::pixels;
  if (requester.is_host()) return is(protocol::MessageKind::load) ? BusKind::load : BusKind::control;
  if (is(protocol::MachineMessage::text)) return BusKind::text;
  return is(protocol::MessageKind::credits) ? BusKind::credits : BusKind::answers;
}

}  // namespace

Bus::Bus(unsigned pes, const MachineDescription& machine, const Jitter& jitter, EventQueue& events,
         std::uint32_t source, std::uint32_t arbiter, BlockPool& pool, BusClient& client)
    : bytes_per_cycle_(machine.bus.bytes_per_cycle),
      arbitration_cycles_(machine.bus.arbitration_cycles),
      signal_cycles_(machine.signal_cycles()),
      jitter_(jitter),
      events_(events),
      source_(source),
      arbiter_(arbiter),
      pool_(pool),
      client_(client),
      requests_(1 + std::size_t{2} * pes, BusRequest::none),
      room_(1 + std::size_t{2} * pes),
      frame_buffer_(1 + std::size_t{2} * pes),
      places_(machine.frame_buffer.queue_messages),
      requesters_(1 + 2 * pes) {
  figures_.from_pe.resize(pes);
  figures_.to_pe.resize(pes);
}

void Bus::request(BusRequester requester, BusRequest what, Cycles now) {
  BusRequest& line = requests_[requester.number()];
  if (line != BusRequest::none) return;
  line = what;
  if (signal_cycles_ == 0) return see(requester.number(), now);
  events_.push(now + signal_cycles_, source_, EventKind::bus_request, 0, 0, requester.number());
}

void Bus::free_place(Cycles now) {
  if (signal_cycles_ == 0) return see_place(now);
  events_.push(now + signal_cycles_, source_, EventKind::bus_place, 0, 0, 0);
}

void Bus::handle(const Event& event) {
  if (event.kind == EventKind::bus_request) return see(event.block, event.time);
  if (event.kind == EventKind::bus_place) return see_place(event.time);
  scheduled_ = false;
  const std::size_t next = busy_ ? ReadySet::kNobody : next_in_turn();
  if (next != ReadySet::kNobody) grant(static_cast<std::uint32_t>(next), event.time);
}

void Bus::see(std::uint32_t requester, Cycles now) {
  set_seen(requester, requests_[requester]);
  schedule(now);
}

void Bus::see_place(Cycles now) {
  ++places_;
  schedule(now);
}

void Bus::set_seen(std::uint32_t requester, BusRequest what) {
  room_.set(requester, what == BusRequest::room);
  frame_buffer_.set(requester, what == BusRequest::frame_buffer);
}

void Bus::transfer_done(Cycles now) {
  busy_ = false;
  schedule(now);
}

/// All requests that are seen in this cycle count, whatever the order of events.
void Bus::schedule(Cycles now) {
  if (busy_ || scheduled_ || next_in_turn() == ReadySet::kNobody) return;
  scheduled_ = true;
  events_.push(now, arbiter_, EventKind::bus_arbitrate, 0, 0, 0);
}

std::size_t Bus::next_in_turn() const {
  const std::size_t room = room_.next(next_);
  const std::size_t pixels = places_ != 0 ? frame_buffer_.next(next_) : ReadySet::kNobody;
  if (room == ReadySet::kNobody || pixels == ReadySet::kNobody) return room != ReadySet::kNobody ? room : pixels;
  const auto turns = [this](std::size_t requester) { return (requester + requesters_ - next_) % requesters_; };
  return turns(room) < turns(pixels) ? room : pixels;
}

void Bus::grant(std::uint32_t number, Cycles now) {
  next_ = (number + 1) % requesters_;
  busy_ = true;
  if (requests_[number] == BusRequest::frame_buffer) --places_;
  const BusSend send = client_.take(BusRequester(number), requests_[number]);
  requests_[number] = send.next;
  set_seen(number, send.next);
  const Cycles duration = count(BusRequester(number), pool_[send.block]);
  events_.push(now + duration, source_, EventKind::bus_done, 0, 0, send.block);
}

/// How long the transfer takes.
Cycles Bus::count(BusRequester requester, const Block& block) {
  const std::uint32_t bytes = block.bytes + static_cast<std::uint32_t>(sizeof(protocol::MessageHeader));
  const Cycles arbitration = arbitration_cycles_ + jitter_.delay(Jitter::What::bus, figures_.transfers);
  const Cycles data = (bytes + bytes_per_cycle_ - 1) / bytes_per_cycle_;
  figures_.arbitration_cycles += arbitration;
  figures_.data_cycles += data;
  ++figures_.transfers;
  const auto add = [&](BusTraffic& traffic) { traffic.add(bytes, arbitration + data); };
  add(figures_.users[static_cast<std::size_t>(user_of(requester))]);
  kind_ = kind_of(requester, block);
  add(figures_.kinds[static_cast<std::size_t>(kind_)]);
  if (!requester.is_host()) {
    add(figures_.from_pe[requester.pe()]);
  } else if (!block.is_broadcast() && block.destination != protocol::kFrameBuffer) {
    add(figures_.to_pe[block.destination]);
  }
  return arbitration + data;
}

}  // namespace torolux
