// SPDX-License-Identifier: MIT
// The host in the machine: inbox, program, and a line of sends for each PE.
#include "emulator/host/host_actor.hpp"

#include <algorithm>
#include <string>

#include "emulator/errors.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {

HostActor::HostActor(const MachineDescription& machine, HostProgram& program, std::vector<NiuNetworkSide>& nius,
                     EventQueue& events, std::uint32_t source, BlockPool& pool)
    : clock_(machine),
      program_(program),
      nius_(nius),
      events_(events),
      source_(source),
      pool_(pool),
      lines_(nius.size()),
      ready_(nius.size()) {}

void HostActor::send_message(PeNumber pe, std::uint16_t kind, std::span<const std::byte> contents) {
  if (pe >= lines_.size() || contents.size() > protocol::kMostMessageBytes) {
    throw MachineFailure("the host program sends PE " + std::to_string(pe) + " of " + std::to_string(lines_.size()) +
                         " a message of " + std::to_string(contents.size()) + " bytes; the most is " +
                         std::to_string(protocol::kMostMessageBytes));
  }
  const BlockIndex block = pool_.take();
  pool_[block].message_kind = kind;
  pool_[block].set_payload(contents);
  queue_for(pe, block);
}

void HostActor::send_records(PeNumber pe, std::span<const std::byte> records, std::uint32_t record_bytes) {
  const std::size_t count = record_bytes != 0 ? records.size() / record_bytes : 0;
  if (pe >= lines_.size() || count == 0 || count > protocol::kMostRecordsPerPacket ||
      records.size() != count * record_bytes || records.size() > protocol::kMostPacketBytes) {
    throw MachineFailure("the host program sends PE " + std::to_string(pe) + " of " + std::to_string(lines_.size()) +
                         " records of " + std::to_string(record_bytes) + " bytes, " + std::to_string(records.size()) +
                         " in all; 1 to " + std::to_string(protocol::kMostRecordsPerPacket) + " records and at most " +
                         std::to_string(protocol::kMostPacketBytes) + " bytes make a packet");
  }
  const BlockIndex block = pool_.take();
  pool_[block].records = static_cast<std::uint16_t>(count);
  pool_[block].set_payload(records);
  queue_for(pe, block);
}

void HostActor::queue_for(PeNumber pe, BlockIndex index) {
  Block& block = pool_[index];
  block.number = (std::uint64_t{protocol::kHost} << 32U) | numbers_++;
  block.source = protocol::kHost;
  block.destination = pe;
  clock_.work(HostWork::message, 1);
  clock_.work(HostWork::copy, host_lines(block.bytes));
  ++lines_[pe].made;
  events_.push(clock_.now(), source_, EventKind::host_queue, pe, 0, index);
}

void HostActor::start() {
  program_.start(*this);
}

void HostActor::arrive(BlockIndex block, Cycles now) {
  inbox_.push_back(block);
  schedule_step(now);
}

void HostActor::schedule_step(Cycles now) {
  if (stepping_ || inbox_.empty()) return;
  stepping_ = true;
  clock_.wait_until(now);
  clock_.work(HostWork::message, 1);
  const Block& first = pool_[inbox_.front()];  // diverted records only pass through
  if (first.records == 0) clock_.work(HostWork::copy, host_lines(first.bytes));
  events_.push(clock_.now(), source_, EventKind::host_step, 0, 0, 0);
}

void HostActor::step() {
  stepping_ = false;
  const BlockIndex index = inbox_.front();
  inbox_.pop_front();
  Block& block = pool_[index];
  if (block.records != 0) {  // diverted: back to where it wanted to go
    clock_.work(HostWork::message, 1);
    lines_[block.destination].diverted += block.records;
    events_.push(clock_.now(), source_, EventKind::host_queue, block.destination, 1, index);
  } else {
    program_.on_message(*this, block.source, block.message_kind, block.payload());
    pool_.give_back(index);
  }
  schedule_step(clock_.now());
}

void HostActor::enqueue(unsigned pe, BlockIndex block) {
  Line& line = lines_[pe];
  (pool_[block].source == protocol::kHost ? line.program : line.resend).push(pool_, block);
  room_changed(pe);
}

/// Whether the first of a queue has room at its PE.
bool HostActor::fits(unsigned pe, const BlockQueue& queue) const {
  if (queue.empty()) return false;
  const std::uint32_t records = pool_[queue.front()].records;
  return records != 0 ? nius_[pe].has_slots(records) : nius_[pe].has_control_buffer();
}

void HostActor::room_changed(unsigned pe) {
  const Line& line = lines_[pe];
  ready_.set(pe, fits(pe, line.program) || fits(pe, line.resend));
}

BlockIndex HostActor::take() {
  const auto pe = static_cast<unsigned>(ready_.next(next_pe_));
  next_pe_ = (pe + 1) % static_cast<unsigned>(lines_.size());
  Line& line = lines_[pe];
  const bool resend = fits(pe, line.resend);
  const BlockIndex block = (resend ? line.resend : line.program).pop(pool_);
  if (!resend) --line.made;
  if (const std::uint32_t records = pool_[block].records; records != 0) {
    nius_[pe].reserve_slots(records);
  } else {
    nius_[pe].reserve_control_buffer();
  }
  room_changed(pe);
  return block;
}

}  // namespace torolux
