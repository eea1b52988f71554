// SPDX-License-Identifier: MIT
// What a program asks of messages: send, receive, exchange. How packets become messages is in arrivals.cpp.
#include "firmware/kit/messenger.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <utility>

namespace torolux::kit {

Messenger::Messenger(pe::Niu& niu, std::uint32_t slots) : niu_(niu), slots_(niu.memory().at<std::byte>(slots)) {
  if (std::uint64_t{slots} + kSlotBytes > niu_.memory_end()) {
    fail(Words() << "no memory for " << kSlotBytes << " bytes of record slots: the machine has " <<
         niu_.window().local_memory_bytes << " bytes for each PE (--pe-memory)");
  }
  niu_.set_slots(slots, kRecordBytes, kRecordsPerPacket, kNiuSlots);
  if (!peers_.begin(niu_.pes())) fail(Words() << "no memory for the table of " << niu_.pes() << " PEs");
}

Messenger::~Messenger() {
  for (std::uint32_t pe = 0; pe < niu_.pes(); ++pe) {
    Peer* peer = peers_.of(pe);
    if (peer == nullptr) continue;
    std::free(peer->open);
    while (peer->early != nullptr) std::free(std::exchange(peer->early, peer->early->next));
  }
  for (Queue& queue : queues_) {
    while (queue.first != nullptr) std::free(std::exchange(queue.first, queue.first->next));
  }
  peers_.end();
}

void Messenger::fail(const Words& words) const {
  static Words all;
  all = Words() << function_ << ": " << words.text();
  pe::Niu niu = niu_;
  const auto place = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(from_));
  niu.fail(pe::FaultCode::words, niu.memory().address_of(all.text().data()),
           static_cast<std::uint32_t>(all.text().size()), place);
}

void Messenger::check_pe(int pe) const {
  if (pe >= 0 && static_cast<std::uint32_t>(pe) < niu_.pes()) return;
  fail(Words() << "there is no PE " << pe << "; the machine has PEs 0 to " << niu_.pes() - 1);
}

void Messenger::check_room(std::uint32_t bytes, std::uint32_t source, std::size_t room) const {
  if (bytes <= room) return;
  fail(Words() << "the message of PE " << source << " has " << bytes << " bytes; there is room for " << room);
}

// ---- Sending ----

void Messenger::send(Channel channel, int pe, std::span<const std::byte> data) {
  check_pe(pe);
  if (data.size() > kMostMessage) {
    fail(Words() << "a message of " << data.size() << " bytes; the most is " << kMostMessage);
  }
  if (static_cast<std::uint32_t>(pe) == niu_.pe()) return send_to_self(channel, data);
  send_packets(channel, static_cast<std::uint16_t>(pe), data);
}

/// As if one packet had brought it all.
void Messenger::send_to_self(Channel channel, std::span<const std::byte> data) {
  Peer& peer = peer_of(niu_.pe());
  const auto bytes = static_cast<std::uint32_t>(data.size());
  const PacketHead head{niu_.pe(), channel, 0, 0, bytes, 0};
  std::byte* const to = place_for(peer, head);
  if (bytes != 0) std::memcpy(to, data.data(), bytes);
  placed(peer, head, bytes);
}

/// Long messages leave room for what comes: both sides of an exchange send at once.
void Messenger::send_packets(Channel channel, std::uint16_t pe, std::span<const std::byte> data) {
  constexpr std::array<pe::Slot, kRecordsPerPacket> slots = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  Peer& peer = peer_of(pe);
  PacketHead head{niu_.pe(), channel, 0, peer.sent, static_cast<std::uint32_t>(data.size()), 0};
  for (;;) {
    const auto payload = static_cast<std::uint32_t>(std::min<std::size_t>(kMostPayload, head.bytes - head.offset));
    std::memcpy(slots_, &head, sizeof head);
    if (payload != 0) std::memcpy(slots_ + sizeof head, data.data() + head.offset, payload);
    niu_.send_records(pe, std::span(slots).first(records_of(payload)));
    ++head.number;
    head.offset += payload;
    if (head.offset == head.bytes) break;
    peer.sent = head.number;
    drain();
  }
  peer.sent = head.number;
}

// ---- Receiving ----

std::size_t Messenger::receive(Channel channel, int pe, std::span<std::byte> room) {
  if (pe != kAnyPe) check_pe(pe);
  Waiting* before = nullptr;
  if (Waiting* message = next_of(channel, pe, &before)) return hand_over(channel, message, before, room);
  post(channel, pe, room);
  return wait_for_posted();
}

std::size_t Messenger::exchange(int to, std::span<const std::byte> data, int from, std::span<std::byte> room) {
  if (from != kAnyPe) check_pe(from);
  const std::less<const std::byte*> before_in_memory;
  if (!data.empty() && !room.empty() && before_in_memory(data.data(), room.data() + room.size()) &&
      before_in_memory(room.data(), data.data() + data.size())) {
    fail(Words() << "what is sent and where to receive overlap in memory");
  }
  Waiting* before = nullptr;
  if (next_of(Channel::program, from, &before) != nullptr) {
    send(Channel::program, to, data);
    return receive(Channel::program, from, room);
  }
  post(Channel::program, from, room);
  send(Channel::program, to, data);
  return wait_for_posted();
}

std::int64_t Messenger::waiting(Channel channel, int pe) {
  if (pe != kAnyPe) check_pe(pe);
  drain();
  Waiting* before = nullptr;
  const Waiting* message = next_of(channel, pe, &before);
  return message != nullptr ? static_cast<std::int64_t>(message->bytes) : -1;
}

/// The first whole message from there, and the one before it in the queue.
Waiting* Messenger::next_of(Channel channel, int pe, Waiting** before) {
  *before = nullptr;
  for (Waiting* message = queue_of(channel).first; message != nullptr; message = message->next) {
    if (pe == kAnyPe || message->source == static_cast<std::uint32_t>(pe)) return message;
    *before = message;
  }
  return nullptr;
}

std::size_t Messenger::hand_over(Channel channel, Waiting* message, Waiting* before, std::span<std::byte> room) {
  check_room(message->bytes, message->source, room.size());
  Queue& queue = queue_of(channel);
  (before != nullptr ? before->next : queue.first) = message->next;
  if (queue.last == message) queue.last = before;
  const std::size_t bytes = message->bytes;
  if (bytes != 0) std::memcpy(room.data(), message->data(), bytes);
  source_ = message->source;
  forget(message);
  return bytes;
}

/// A message of which a part is on the heap goes on in its place.
void Messenger::post(Channel channel, int from, std::span<std::byte> room) {
  posted_ = {true, false, false, channel, from, 0, 0, room};
  if (from == kAnyPe) return;
  Peer& peer = peer_of(static_cast<std::uint32_t>(from));
  Waiting* const part = peer.open;
  if (part == nullptr || part->channel != channel) return;
  claim(part->source, part->bytes);
  const auto have = static_cast<std::size_t>(peer.into - part->data());
  std::memcpy(room.data(), part->data(), have);
  peer.into = room.data() + have;
  peer.open = nullptr;
  forget(part);
}

std::size_t Messenger::wait_for_posted() {
  while (!posted_.done) {
    const auto& arrival = niu_.receive();
    take(arrival);
  }
  posted_.open = false;
  source_ = posted_.source;
  return posted_.bytes;
}

bool Messenger::posted_takes(Channel channel, std::uint32_t source) const {
  return posted_.open && !posted_.claimed && posted_.channel == channel &&
         (posted_.from == kAnyPe || static_cast<std::uint32_t>(posted_.from) == source);
}

void Messenger::claim(std::uint32_t source, std::uint32_t bytes) {
  check_room(bytes, source, posted_.room.size());
  posted_.claimed = true;
  posted_.source = static_cast<std::uint16_t>(source);
  posted_.bytes = bytes;
}

const protocol::MessageHeader& Messenger::receive_from_host() {
  for (;;) {
    const auto& arrival = niu_.receive();
    if (arrival.kind == protocol::ArrivalKind::message) return niu_.message();
    take(arrival);
  }
}

}  // namespace torolux::kit
