// SPDX-License-Identifier: MIT
// What a program asks of messages: send, receive, exchange. How packets become messages is in arrivals.cpp.
#include "firmware/kit/messenger.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>
#include <utility>

namespace torolux::kit {
namespace {

/// Of the NIU's slots, so many for each packet sent before what has come is taken in: while one is made and sent (200
/// cycles or more) two or three may come, of 16 records each.
constexpr std::uint32_t kSlotsForAPacket = 64;

constexpr std::string_view kAllTheSame = ": all PEs must call the same, in the same order";

}  // namespace

Messenger::Messenger(pe::Niu& niu, const SlotLayout& slots)
    : niu_(niu),
      layout_(slots),
      slots_(niu.memory().at<std::byte>(slots.first)),
      staging_(niu.memory().at<std::byte>(slots.staging)),
      staging_slot_(static_cast<pe::Slot>(slots.own - kRecordsPerPacket)) {
  niu_.set_slots(slots.first, kRecordBytes, slots.own, slots.niu);
  if (!peers_.begin(niu_.pes())) fail(Words() << "no memory for the table of " << niu_.pes() << " PEs");
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

void Messenger::fail_other_call(std::uint32_t source, Call theirs) const {
  fail(Words() << "PE " << source << " calls " << theirs
               << (theirs.at_place_of(call_) ? " where this one calls "
                                             : " at another place in the order than this one ")
               << call_ << kAllTheSame);
}

void Messenger::fail_no_room(std::uint32_t bytes, std::uint32_t source, std::size_t room) const {
  fail(Words() << "the message of PE " << source << " has " << bytes << " bytes; there is room for " << room);
}

// ---- The end ----

void Messenger::end() {
  called("exit", together_from_);
  if (const Waiting* left = queue_of(Channel::together).first.get()) fail_left_over(left->source, left->call);
  // What has come goes nowhere any more, so slots are not given back: that ends this, whatever others send.
  for (;;) {
    const auto& arrival = niu_.receive_if_any();
    if (arrival.kind == protocol::ArrivalKind::none) return;
    if (arrival.kind != protocol::ArrivalKind::records) continue;
    const PacketHead head = head_of(arrival);
    if (head.channel == Channel::together) fail_left_over(head.source, head.call);
  }
}

void Messenger::fail_left_over(std::uint32_t source, Call theirs) const {
  Words words;
  words << "PE " << source;
  if (theirs == call_) {
    words << " takes part in " << theirs << " with more bytes than this one";
  } else if (theirs.at_place_of(call_)) {
    words << " calls " << theirs << " where this one calls " << call_;
  } else {
    words << " calls " << theirs << ", and this one ends without it";
  }
  fail(words << kAllTheSame);
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
  const PacketHead head{niu_.pe(), channel, 0, 0, bytes, call_};
  std::byte* const to = place_for(peer, head);
  if (bytes != 0) std::memcpy(to, data.data(), bytes);
  placed(peer, head, bytes);
}

/// What has come meanwhile is best taken when it is asked for, into its place; but it must not fill all slots.
void Messenger::send_packets(Channel channel, std::uint16_t pe, std::span<const std::byte> data) {
  Peer& peer = peer_of(pe);
  PacketHead head{niu_.pe(), channel, 0, peer.sent, static_cast<std::uint32_t>(data.size()), call_};
  for (;;) {
    const std::uint32_t payload = send_part(pe, head, data.last(head.left));
    peer.sent = ++head.number;
    head.left -= payload;
    if (++sent_since_drain_ >= layout_.niu / kSlotsForAPacket) drain();
    if (head.left == 0) return;
  }
}

/// One packet; the bytes that it takes along. What lies in local memory goes from its place, in whole records, once the
/// bytes before the first of them have gone with the head.
std::uint32_t Messenger::send_part(std::uint16_t pe, PacketHead& head, std::span<const std::byte> rest) {
  const std::less<const std::byte*> before;
  const bool small = rest.size() <= kMostLead;
  if (small || before(rest.data(), slots_) || !before(rest.data() + rest.size(), staging_)) {
    return send_staged(pe, head, rest.first(std::min<std::size_t>(rest.size(), kMostPayload)));
  }
  const auto lead = static_cast<std::uint32_t>(-(rest.data() - slots_)) % kRecordBytes;
  if (lead > kMostLead) return send_staged(pe, head, rest.first(kMostLead));  // the next is nearer
  return send_from_place(pe, head, rest, lead);
}

void Messenger::put_head(const PacketHead& head) {
  std::memcpy(std::assume_aligned<alignof(PacketHead)>(staging_), &head, sizeof head);
}

/// In the staging slots; `data` fits, and fills its records unless it ends the message.
std::uint32_t Messenger::send_staged(std::uint16_t pe, PacketHead& head, std::span<const std::byte> data) {
  const auto payload = static_cast<std::uint32_t>(data.size());
  head.lead = static_cast<std::uint8_t>(std::min(payload, kMostLead));
  put_head(head);
  if (payload != 0) std::memcpy(staging_ + sizeof head, data.data(), payload);
  niu_.send_records(pe, staging_slot_, static_cast<pe::Slot>(staging_slot_ + 1), records_of(payload) - 1);
  return payload;
}

/// The last record may go beyond the message's end: the receiver knows its length.
std::uint32_t Messenger::send_from_place(std::uint16_t pe, PacketHead& head, std::span<const std::byte> rest,
                                         std::uint32_t lead) {
  head.lead = static_cast<std::uint8_t>(lead);
  put_head(head);
  if (lead != 0) std::memcpy(staging_ + sizeof head, rest.data(), lead);
  const auto whole = static_cast<std::uint32_t>(rest.size()) - lead;
  const std::uint32_t records = std::min(kRecordsPerPacket - 1, (whole + kRecordBytes - 1) / kRecordBytes);
  const auto first = static_cast<std::uint32_t>(rest.data() + lead - slots_) / kRecordBytes;
  niu_.send_records(pe, staging_slot_, static_cast<pe::Slot>(first), records);
  return lead + std::min(whole, records * kRecordBytes);
}

// ---- Receiving ----

std::size_t Messenger::receive(Channel channel, int pe, std::span<std::byte> room) {
  if (pe != kAnyPe) check_pe(pe);
  if (Waiting* before = nullptr; next_of(channel, pe, &before) != nullptr) return hand_over(channel, before, room);
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

/// The first whole message from there; before: the one before it in the queue, or null.
const Waiting* Messenger::next_of(Channel channel, int pe, Waiting** before) {
  *before = nullptr;
  for (Waiting* message = queue_of(channel).first.get(); message != nullptr; message = message->next.get()) {
    if (pe == kAnyPe || message->source == static_cast<std::uint32_t>(pe)) return message;
    *before = message;
  }
  return nullptr;
}

/// The message behind `before`.
std::size_t Messenger::hand_over(Channel channel, Waiting* before, std::span<std::byte> room) {
  Queue& queue = queue_of(channel);
  Block<Waiting>& place = before != nullptr ? before->next : queue.first;
  check(channel, place->source, place->bytes, place->call, room.size());
  const Block<Waiting> message = std::move(place);
  place = std::move(message->next);
  if (queue.last == message.get()) queue.last = before;
  if (message->bytes != 0) std::memcpy(room.data(), behind(*message), message->bytes);
  source_ = message->source;
  waiting_bytes_ -= message->bytes;
  return message->bytes;
}

/// A message of which a part is on the heap goes on in its place.
void Messenger::post(Channel channel, int from, std::span<std::byte> room) {
  posted_ = {true, false, false, channel, from, 0, 0, room};
  if (from == kAnyPe) return;
  Peer& peer = peer_of(static_cast<std::uint32_t>(from));
  if (!peer.open || peer.open->channel != channel) return;
  const Block<Waiting> part = std::move(peer.open);
  claim(part->source, part->bytes, part->call);
  const auto have = static_cast<std::size_t>(peer.into - behind(*part));
  std::memcpy(room.data(), behind(*part), have);
  peer.into = room.data() + have;
  waiting_bytes_ -= part->bytes;
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

void Messenger::claim(std::uint32_t source, std::uint32_t bytes, Call call) {
  check(posted_.channel, source, bytes, call, posted_.room.size());
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
