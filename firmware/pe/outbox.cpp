// SPDX-License-Identifier: MIT
// Open batches and own record slots. Enters: records that leave; leaves: packets.
#include "firmware/pe/outbox.hpp"

namespace torolux::pe {

void RecordSlots::set(const Memory& memory, const protocol::StageLayout& layout) {
  first_ = memory.at<std::byte>(layout.record_slots.address);
  count_ = layout.record_slots.count;
  own_ = layout.own_slots;
  free_count_ = 0;
  for (std::uint32_t slot = own_; slot-- > 0;) free_own(static_cast<Slot>(slot));
}

Slot RecordSlots::take(Niu& niu) {
  if (free_count_ == 0) niu.fail(FaultCode::own_slots_exhausted, own_);
  return free_[--free_count_];
}

void Outbox::set(const protocol::StageLayout& layout) {
  batches_ = {};
  used_ = 0;
  mask_ = layout.open_batches - 1U;
  most_ = protocol::records_per_packet(layout.stage);
}

void Outbox::put(Niu& niu, RecordSlots& slots, PeNumber destination, Slot slot) {
  Batch& batch = batches_[destination & mask_];
  if (batch.count > 0 && batch.destination != destination) send(niu, slots, batch);
  if (batch.count == 0) {
    batch.destination = destination;
    ++used_;
  }
  batch.slots[batch.count++] = slot;
  if (batch.count == most_) send(niu, slots, batch);
}

void Outbox::send(Niu& niu, RecordSlots& slots, Batch& batch) {
  niu.send_records(batch.destination, std::span<const Slot>(batch.slots.data(), batch.count));
  for (std::uint32_t i = 0; i < batch.count; ++i) slots.free_own(batch.slots[i]);
  batch.count = 0;
  --used_;
}

void Outbox::flush(Niu& niu, RecordSlots& slots) {
  for (std::uint32_t i = 0; used_ > 0; ++i) {
    if (batches_[i].count > 0) send(niu, slots, batches_[i]);
  }
}

}  // namespace torolux::pe
