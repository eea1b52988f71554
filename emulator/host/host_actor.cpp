// SPDX-License-Identifier: MIT
// The host in the machine: inbox, program, and a line of sends for each PE.
#include "emulator/host/host_actor.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include "emulator/errors.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {

namespace {
constexpr std::size_t index_of(HostQueue queue) {
  return static_cast<std::size_t>(queue);
}
}  // namespace

HostActor::HostActor(const MachineDescription& machine, HostProgram& program, unsigned pes, EventQueue& events,
                     std::uint32_t source, BlockPool& pool)
    : clock_(machine), program_(&program), events_(events), source_(source), pool_(pool), lines_(pes), ready_(pes) {
  for (Line& line : lines_) line.control_buffers = machine.bus.control_buffers;
}

void HostActor::send_message(PeNumber pe, std::uint16_t kind, std::span<const std::byte> contents) {
  if (pe >= lines_.size()) {
    throw MachineFailure("the host program sends a message to PE " + std::to_string(pe) + " of " +
                         std::to_string(lines_.size()));
  }
  queue_for(pe, make_message(pe, kind, contents));
  ++lines_[pe].made;
}

void HostActor::broadcast(std::uint16_t kind, std::span<const std::byte> contents) {
  queue_for(kEveryPe, make_message(kEveryPe, kind, contents));
  ++broadcasts_made_;
}

BlockIndex HostActor::make_message(std::uint16_t destination, std::uint16_t kind, std::span<const std::byte> contents) {
  if (contents.size() > protocol::kMostMessageBytes) {
    throw MachineFailure("the host program sends " +
                         (destination == kEveryPe ? std::string("all PEs") : "PE " + std::to_string(destination)) +
                         " a message of " + std::to_string(contents.size()) + " bytes; the most is " +
                         std::to_string(protocol::kMostMessageBytes));
  }
  const BlockIndex block = pool_.take();
  pool_[block].message_kind = kind;
  pool_.set_payload(block, contents);
  return block;
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
  pool_.set_payload(block, records);
  queue_for(pe, block);
  ++lines_[pe].made;
}

/// The bus is held at once for as long as the answer takes, which the message has room for.
void HostActor::read_pixels(const FrameRead& read) {
  if (read.count == 0 || read.count > kMostPixelsRead) {
    throw MachineFailure("the host program reads " + std::to_string(read.count) +
                         " pixels of the frame buffer at once: 1 to " + std::to_string(kMostPixelsRead) + " can be");
  }
  std::array<std::byte, kMostBlockBytes> message{};
  std::memcpy(message.data(), &read, sizeof read);
  const BlockIndex index = pool_.take();
  pool_.set_payload(index, std::span(message).first(sizeof read + read.count * sizeof(PixelSums)));
  queue_for(protocol::kFrameBuffer, index);
}

void HostActor::queue_for(std::uint16_t destination, BlockIndex index) {
  Block& block = pool_[index];
  block.number = (std::uint64_t{protocol::kHost} << 32U) | numbers_++;
  block.source = protocol::kHost;
  block.destination = destination;
  clock_.work(HostWork::message, 1);
  clock_.work(HostWork::copy, host_lines(block.bytes));
  events_.push(clock_.now(), source_, EventKind::host_queue, destination, 0, index);
}

void HostActor::start(HostClient& client) {
  client_ = &client;
  in_program([this] { program_->start(*this); });
}

void HostActor::go_on_with(HostProgram& program, Cycles now) {
  program_ = &program;
  clock_.wait_until(now);
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
    tell_program(block);
    pool_.give_back(index);
  }
  schedule_step(clock_.now());
}

void HostActor::tell_program(const Block& block) {
  if (block.source != protocol::kHost) {
    in_program([&] { program_->on_message(*this, block.source, block.message_kind, block.payload()); });
    ++messages_read_;
    return;
  }
  FrameRead read{};
  std::memcpy(&read, block.payload().data(), sizeof read);
  std::array<PixelSums, kMostPixelsRead> sums{};
  std::memcpy(sums.data(), &block.payload()[sizeof read], read.count * sizeof(PixelSums));
  in_program([&] { program_->on_pixels(*this, read, std::span(sums).first(read.count)); });
}

bool HostActor::is_barrier(BlockIndex block) const {
  return pool_[block].is_broadcast() || pool_[block].destination == protocol::kFrameBuffer;
}

HostQueue HostActor::enqueue(unsigned pe, BlockIndex block) {
  const HostQueue queue = pool_[block].source == protocol::kHost ? HostQueue::program : HostQueue::resend;
  const bool waits = is_barrier(block) || !behind_.empty();
  if (queue == HostQueue::program && waits) {
    behind_.push(pool_, block);
  } else {
    put(pe, queue, block);
  }
  return queue;
}

void HostActor::put(unsigned pe, HostQueue queue, BlockIndex block) {
  lines_[pe].queues[index_of(queue)].push(pool_, block);
  if (queue == HostQueue::program) ++ahead_;
  update(pe);
}

std::optional<unsigned> HostActor::let_through() {
  if (behind_.empty() || is_barrier(behind_.front())) return std::nullopt;
  const BlockIndex block = behind_.pop(pool_);
  const unsigned pe = pool_[block].destination;
  put(pe, HostQueue::program, block);
  return pe;
}

std::uint32_t HostActor::ask_for_slots(unsigned pe, HostQueue queue) {
  Line& line = lines_[pe];
  const BlockQueue& blocks = line.queues[index_of(queue)];
  Slots& slots = line.slots[index_of(queue)];
  if (blocks.empty() || slots != Slots::none) return 0;
  const std::uint32_t records = pool_[blocks.front()].records;
  if (records != 0) slots = Slots::asked;
  return records;
}

void HostActor::slots_granted(unsigned pe, HostQueue queue) {
  lines_[pe].slots[index_of(queue)] = Slots::granted;
  update(pe);
}

void HostActor::control_buffer_free(unsigned pe) {
  if (++lines_[pe].control_buffers == 1) --full_;
  update(pe);
}

/// Whether the first of a queue has room at its PE.
bool HostActor::fits(unsigned pe, HostQueue queue) const {
  const Line& line = lines_[pe];
  const BlockQueue& blocks = line.queues[index_of(queue)];
  if (blocks.empty()) return false;
  if (pool_[blocks.front()].records != 0) return line.slots[index_of(queue)] == Slots::granted;
  return line.control_buffers != 0;
}

void HostActor::update(unsigned pe) {
  ready_.set(pe, fits(pe, HostQueue::program) || fits(pe, HostQueue::resend));
}

void HostActor::use_control_buffer(Line& line) {
  if (--line.control_buffers == 0) ++full_;
}

BlockIndex HostActor::take_broadcast() {
  --broadcasts_made_;
  for (Line& line : lines_) use_control_buffer(line);
  return behind_.pop(pool_);
}

/// Diverted records before a broadcast, as before all else.
HostActor::Taken HostActor::take() {
  if (ready_.empty()) return {take_broadcast(), 0, HostQueue::program};
  const auto pe = static_cast<unsigned>(ready_.next(next_pe_));
  next_pe_ = (pe + 1) % static_cast<unsigned>(lines_.size());
  Line& line = lines_[pe];
  const HostQueue queue = fits(pe, HostQueue::resend) ? HostQueue::resend : HostQueue::program;
  const BlockIndex block = line.queues[index_of(queue)].pop(pool_);
  if (queue == HostQueue::program) {
    --line.made;
    --ahead_;
  }
  if (pool_[block].records != 0) {
    line.slots[index_of(queue)] = Slots::none;
  } else {
    use_control_buffer(line);
  }
  update(pe);
  return {block, pe, queue};
}

}  // namespace torolux
