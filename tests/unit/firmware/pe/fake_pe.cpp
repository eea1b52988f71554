// SPDX-License-Identifier: MIT
// A PE's side of its fake NIU: HINTs in, packets and messages into the machine's queues out. Checks what firmware owes
// the NIU.
#include "tests/unit/firmware/pe/fake_pe.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include "tests/unit/firmware/pe/fake_machine.hpp"
#include "tests/unit/firmware/pe/niu_rules.hpp"

namespace torolux::test {
namespace {

using protocol::Hint;
using protocol::MessageKind;

struct Asleep {};
struct Halted {};

}  // namespace

PeFailed::PeFailed(const protocol::Fault& f)
    : std::runtime_error("PE failed: code " + std::to_string(f.code) + ", " + std::to_string(f.detail[0]) + " " +
                         std::to_string(f.detail[1]) + " " + std::to_string(f.detail[2])),
      fault(f) {}

FakePe::FakePe(FakeMachine& machine, std::uint16_t number, std::uint16_t pes, std::uint32_t local_memory_bytes)
    : machine_(machine),
      number_(number),
      bytes_(local_memory_bytes),
      memory_(std::make_unique<std::byte[]>(local_memory_bytes)),
      page_(new (memory_.get()) pe::NiuPage{}),
      niu_(*page_, pe::Memory(pe::LocalBase(memory_.get(), stores_begin())), pe::HintGate(*this)) {
  window().pe = number;
  window().columns = pes;
  window().rows = 1;
  window().local_memory_bytes = local_memory_bytes;
}

std::uint32_t FakePe::stores_begin() const {
  return protocol::kLocalMemoryBase + protocol::kPageBytes;
}

void FakePe::work() {
  if (halted_) return;
  try {
    pe::run_pe(*pe_, niu_);
    halted_ = true;
  } catch (const Asleep&) {  // it goes on at the next call
  } catch (const Halted&) {
    halted_ = true;
  }
}

void FakePe::hint(std::int32_t immediate) {
  switch (static_cast<Hint>(immediate)) {
    case Hint::send_records:
      return send_records();
    case Hint::send_message:
      return send_message();
    case Hint::receive:
      return receive(true);
    case Hint::receive_if_any:
    case Hint::receive_more:
    case Hint::receive_due:
      return receive(false);
    case Hint::set_slots:
      return set_slots();
    case Hint::halt:
      throw Halted{};
    case Hint::fail:
      throw PeFailed(window().fault);
    default:  // markers
      return;
  }
}

std::byte* FakePe::slot(std::uint16_t number) {
  require(number < slots_.own + slots_.niu, "slot number");
  return memory_.get() + (slots_.address - protocol::kLocalMemoryBase) + std::size_t{number} * slots_.bytes;
}

void FakePe::release() {
  for (std::uint32_t i = 0; i < window().released; ++i) {
    const std::uint16_t s = window().release[i];
    require(s >= slots_.own && s < slots_.own + slots_.niu && in_use_[s], "released a slot that it did not have");
    in_use_[s] = false;
    free_.push_back(s);
  }
  window().released = 0;
}

void FakePe::receive(bool wait) {
  release();
  auto& arrival = window().arrival;
  arrival.kind = protocol::ArrivalKind::none;
  if (arrivals_.empty()) {
    if (wait) throw Asleep{};
    return;
  }
  const Item item = std::move(arrivals_.front());
  arrivals_.pop_front();
  if (item.message.empty() && !item.slots.empty()) {
    arrival.kind = protocol::ArrivalKind::records;
    arrival.source = item.source;
    arrival.count = static_cast<std::uint16_t>(item.slots.size());
    std::copy(item.slots.begin(), item.slots.end(), arrival.slots.begin());
    return;
  }
  arrival.kind = protocol::ArrivalKind::message;
  window().message = {item.kind, item.source, static_cast<std::uint32_t>(item.message.size())};
  if (!item.message.empty()) std::memcpy(window().message_bytes.data(), item.message.data(), item.message.size());
}

void FakePe::set_slots() {
  require(free_.size() == slots_.niu, "slots set while some are in use");
  slots_ = window().slots;
  free_.clear();
  in_use_.assign(slots_.own + slots_.niu, false);
  for (std::uint32_t s = slots_.own + slots_.niu; s-- > slots_.own;) free_.push_back(static_cast<std::uint16_t>(s));
}

void FakePe::send_records() {
  release();
  const auto& out = window().send;
  require(out.count >= 1 && out.count * slots_.bytes <= protocol::kMostPacketBytes && out.count <= 16, "packet size");
  require(out.destination < machine_.pes.size() && out.destination != number_, "packet's destination");
  Packet packet{number_, out.destination, {}};
  for (std::uint32_t i = 0; i < out.count; ++i) {
    const std::uint16_t s = out.slots[i];
    packet.records.emplace_back(slot(s), slot(s) + slots_.bytes);
    if (s < slots_.own) continue;
    require(in_use_[s], "sent a slot that it did not have");
    in_use_[s] = false;
    free_.push_back(s);
  }
  machine_.records_sent += out.count;
  machine_.largest_packet = std::max<std::uint64_t>(machine_.largest_packet, out.count);
  machine_.torus.push_back(std::move(packet));
}

void FakePe::send_message() {
  release();
  const auto& out = window().send;
  const std::byte* from = memory_.get() + (out.address - protocol::kLocalMemoryBase);
  protocol::MessageHeader header{};
  std::memcpy(&header, from, sizeof(header));
  require(header.bytes <= protocol::kMostMessageBytes, "message size");
  from += sizeof(header);
  if (out.destination == protocol::kHost) {
    machine_.to_host.push_back({number_, static_cast<MessageKind>(header.kind), {from, from + header.bytes}});
    return;
  }
  require(out.destination == protocol::kFrameBuffer, "message's destination");
  require(header.kind == static_cast<std::uint16_t>(protocol::MachineMessage::pixels), "kind of pixel message");
  std::vector<protocol::PixelAdd> adds(header.bytes / sizeof(protocol::PixelAdd));
  std::memcpy(adds.data(), from, header.bytes);
  for (const auto& add : adds) {
    auto& plane = add.plane == protocol::Plane::colour ? machine_.pixels : machine_.layers[add.plane];
    for (std::size_t c = 0; c < 3; ++c) plane[add.pixel][c] += add.value[c];
  }
}

bool FakePe::take(const Packet& packet) {
  if (free_.size() < packet.records.size()) return false;
  Item item{packet.source, {}, 0, {}};
  for (const auto& record : packet.records) {
    const std::uint16_t s = free_.back();
    free_.pop_back();
    in_use_[s] = true;
    std::memcpy(slot(s), record.data(), record.size());
    item.slots.push_back(s);
  }
  arrivals_.push_back(std::move(item));
  return true;
}

void FakePe::take_message(std::uint16_t kind, std::span<const std::byte> bytes) {
  arrivals_.push_back({protocol::kHost, {}, kind, {bytes.begin(), bytes.end()}});
}

void FakePe::write(std::uint32_t address, std::span<const std::byte> bytes) {
  std::copy(bytes.begin(), bytes.end(), memory_.get() + (address - protocol::kLocalMemoryBase));
}

std::span<const std::byte> FakePe::at(std::uint32_t address, std::size_t bytes) const {
  return {memory_.get() + (address - protocol::kLocalMemoryBase), bytes};
}

}  // namespace torolux::test
