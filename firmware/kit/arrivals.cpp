// SPDX-License-Identifier: MIT
// Packets that the NIU brings become messages: each sender's in the order of their numbers, whenever they come.
#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>

#include "firmware/kit/messenger.hpp"

namespace torolux::kit {

void Messenger::drain() {
  sent_since_drain_ = 0;
  for (;;) {
    const auto& arrival = niu_.receive_if_any();
    if (arrival.kind == protocol::ArrivalKind::none) return;
    take(arrival);
  }
}

void Messenger::take(const protocol::NiuWindow::Arrival& arrival) {
  if (arrival.kind == protocol::ArrivalKind::records) return take_packet(arrival);
  fail(Words() << "the host has sent a message that nobody has asked for, of kind " << niu_.message().kind);
}

PacketHead Messenger::head_of(const protocol::NiuWindow::Arrival& arrival) const {
  PacketHead head;  // NOLINT(cppcoreguidelines-pro-type-member-init): read below
  std::memcpy(&head, std::assume_aligned<alignof(PacketHead)>(slot(arrival.slots[0])), sizeof head);
  return head;
}

/// Its slots are the NIU's again before anything else happens.
void Messenger::take_packet(const protocol::NiuWindow::Arrival& arrival) {
  const PacketHead head = head_of(arrival);
  const bool ours = head.source < niu_.pes() && static_cast<std::size_t>(head.channel) < kChannels &&
                    head.left <= kMostMessage && head.lead <= kMostLead;
  if (!ours) fail(Words() << "a packet that is none of this library's has come from PE " << arrival.source);
  const std::uint32_t room = head.lead + (arrival.count - 1U) * kRecordBytes;
  const std::uint32_t payload = std::min(room, head.left);
  Peer& peer = peer_of(head.source);
  const bool early = head.number != peer.taken;
  copy_payload(arrival, head, payload, early ? behind(keep_early(peer, head, payload)) : place_for(peer, head));
  niu_.release_arrival();
  if (early) return;
  ++peer.taken;
  placed(peer, head, payload);
  take_early(peer);
}

/// The packet that was missing has come: those behind it that are here.
void Messenger::take_early(Peer& peer) {
  while (peer.early && peer.early->head.number == peer.taken) {
    const Block<Early> next = std::move(peer.early);
    peer.early = std::move(next->next);
    ++peer.taken;
    std::byte* const to = place_for(peer, next->head);
    if (next->payload != 0) std::memcpy(to, behind(*next), next->payload);
    placed(peer, next->head, next->payload);
  }
}

/// Slots that follow each other, as they mostly do, are copied as one.
void Messenger::copy_payload(const protocol::NiuWindow::Arrival& arrival, const PacketHead& head, std::uint32_t payload,
                             std::byte* to) const {
  const std::uint32_t lead = std::min<std::uint32_t>(head.lead, payload);
  if (lead != 0) std::memcpy(to, slot(arrival.slots[0]) + sizeof head, lead);
  to += lead;
  payload -= lead;
  for (std::uint32_t i = 1; payload != 0;) {
    const std::uint32_t first = arrival.slots[i];
    std::uint32_t run = 1;
    while (i + run < arrival.count && arrival.slots[i + run] == first + run) ++run;
    const std::uint32_t part = std::min(payload, run * kRecordBytes);
    std::memcpy(to, slot(first), part);
    to += part;
    payload -= part;
    i += run;
  }
}

/// Where the packet's bytes go: the first of a message finds a place for the whole.
std::byte* Messenger::place_for(Peer& peer, const PacketHead& head) {
  if (peer.into != nullptr) return peer.into;
  if (posted_takes(head.channel, head.source)) {
    claim(head.source, head.left, head.call);
    peer.open.reset();
    peer.into = posted_.room.data();
  } else {
    peer.open = new_waiting(head);
    peer.into = behind(*peer.open);
  }
  return peer.into;
}

void Messenger::placed(Peer& peer, const PacketHead& head, std::uint32_t payload) {
  peer.into += payload;
  if (payload == head.left) end_message(peer, head);
}

/// A message that began before `receive` waited may be the first to end.
void Messenger::end_message(Peer& peer, const PacketHead& head) {
  Block<Waiting> message = std::move(peer.open);
  peer.into = nullptr;
  if (!message) {
    posted_.done = true;
  } else if (posted_takes(head.channel, head.source)) {
    claim(head.source, message->bytes, head.call);
    if (message->bytes != 0) std::memcpy(posted_.room.data(), behind(*message), message->bytes);
    posted_.done = true;
    waiting_bytes_ -= message->bytes;
  } else {
    Queue& queue = queue_of(head.channel);
    Waiting* const last = message.get();
    (queue.last != nullptr ? queue.last->next : queue.first) = std::move(message);
    queue.last = last;
  }
}

Early& Messenger::keep_early(Peer& peer, const PacketHead& head, std::uint32_t payload) {
  Block<Early> early = make_block<Early>(payload);
  if (!early) {
    fail(Words() << "no memory for a packet of PE " << head.source << " that came before others; " << waiting_bytes_
                 << " bytes of messages wait to be received");
  }
  Block<Early>* place = &peer.early;
  const auto is_behind = [&](const Early& other) {  // numbers go around
    return static_cast<std::int32_t>(head.number - other.head.number) > 0;
  };
  while (*place && is_behind(**place)) place = &(*place)->next;
  early->next = std::move(*place);
  early->head = head;
  early->payload = payload;
  *place = std::move(early);
  return **place;
}

Peer& Messenger::peer_of(std::uint32_t pe) {
  Peer* const peer = peers_.of(pe);
  if (peer == nullptr) fail(Words() << "no memory for what is to be known of PE " << pe);
  return *peer;
}

Block<Waiting> Messenger::new_waiting(const PacketHead& head) {
  Block<Waiting> message = make_block<Waiting>(head.left);
  if (!message) {
    fail(Words() << "no memory for a message of " << head.left << " bytes from PE " << head.source
                 << ", which must wait; " << waiting_bytes_
                 << " bytes of messages wait to be received: receive them sooner, or give PEs more "
                 << "memory (--pe-memory)");
  }
  message->bytes = head.left;
  message->source = head.source;
  message->channel = head.channel;
  message->call = head.call;
  waiting_bytes_ += head.left;
  return message;
}

}  // namespace torolux::kit
