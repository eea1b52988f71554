// SPDX-License-Identifier: MIT
// What comes over the bus, and who asks for it: messages and packets of the host, of PEs for the host and the frame
// buffer.
#include "emulator/machine/emulation.hpp"
#include "firmware/protocol/machine.hpp"

namespace torolux {

/// Of the host's program or its diverted records; what waits for a broadcast asks for slots once that has gone.
void Emulation::host_queue(unsigned pe, BlockIndex block) {
  const HostQueue queue = host_.enqueue(pe, block);
  if (pe < pes_) ask_for_slots(pe, queue);
  update_host();
}

/// What the first message of a PE's queue needs.
BusRequest Emulation::first_request(unsigned pe) const {
  const BlockQueue& queue = parts_[pe].outgoing;
  if (queue.empty()) return BusRequest::none;
  return pool_[queue.front()].destination == protocol::kFrameBuffer ? BusRequest::frame_buffer : BusRequest::room;
}

void Emulation::update_host() {
  if (const BusRequest next = host_request(); next != BusRequest::none) {
    bus_.request(BusRequester::host(), next, now_);
  }
}

BusRequest Emulation::host_request() const {
  if (host_.ready()) return BusRequest::room;
  return host_.ready_to_read() ? BusRequest::frame_buffer : BusRequest::none;
}

BusSend Emulation::take_of_host(BusRequest granted) {
  BlockIndex block = kNoBlock;
  if (granted == BusRequest::frame_buffer) {
    block = host_.take_read();
  } else {
    const HostActor::Taken taken = host_.take();
    ask_for_slots(taken.pe, taken.queue);
    block = taken.block;
  }
  while (const auto pe = host_.let_through()) ask_for_slots(*pe, HostQueue::program);
  return {block, host_request()};
}

BusSend Emulation::take(BusRequester requester, BusRequest granted) {
  if (requester.is_host()) return take_of_host(granted);
  const unsigned pe = requester.pe();
  if (requester.is_divert()) return {parts_[pe].diverting, BusRequest::none};
  const BlockIndex block = parts_[pe].outgoing.pop(pool_);
  return {block, first_request(pe)};
}

void Emulation::bus_done(BlockIndex index) {
  const Cycles bus_busy = bus_.figures().busy_cycles();  // one transfer at a time: the rest is this one's
  time_line_.bus_was_busy(now_ - (bus_busy - bus_busy_), now_);
  if (watch_) watch_->bus_was_busy(now_ - (bus_busy - bus_busy_), now_, bus_.kind());
  bus_busy_ = bus_busy;
  const Block& block = pool_[index];
  const unsigned from = block.source;
  const unsigned to = block.destination;
  const bool from_host_queue = from == protocol::kHost;
  const bool is_read = from_host_queue && to == protocol::kFrameBuffer;
  if (record_watcher_ != nullptr && block.records == 0 && !is_read)
    record_watcher_->came(now_, {block.source, block.destination, block.message_kind, block.payload()});
  if (block.records != 0 && !from_host_queue && parts_[to].diverting == index) {
    parts_[to].diverting = kNoBlock;
    host_.arrive(index, now_);
    torus_.try_ejection(to, now_);
  } else if (block.records != 0) {
    copy_in(to, index, true);
  } else if (is_read) {
    controller_.arrive(index, now_);
  } else if (from_host_queue) {
    host_message(index);
  } else {
    nius_[from].left_bus_queue(now_, times_);
    if (to == protocol::kFrameBuffer) {
      controller_.arrive(index, now_);
    } else {
      host_.arrive(index, now_);
    }
  }
  bus_.transfer_done(now_);
}

/// Into a control buffer of its PE, or of every PE.
void Emulation::host_message(BlockIndex index) {
  const Block& message = pool_[index];
  if (!message.is_broadcast()) return nius_[message.destination].deliver(index, now_, pool_, times_);
  pool_.begin_sharing(index);
  for (NiuNetworkSide& niu : nius_) niu.deliver_copy(message, now_, pool_, times_);
  pool_.end_sharing(index);
}

void Emulation::pixels_done(BlockIndex block) {
  const Cycles pixels = FrameBufferController::pixels_of(pool_[block]);
  time_line_.frame_buffer_was_busy(now_ - pixels * cycles_per_pixel_, now_);
  if (watch_) watch_->frame_buffer_was_busy(now_ - pixels * cycles_per_pixel_, now_);
  if (pool_[block].source == protocol::kHost) {
    controller_.answer(block);
    host_.arrive(block, now_);
  } else {
    controller_.add_pixels(block);
  }
  bus_.free_place(now_);
}

}  // namespace torolux
