// SPDX-License-Identifier: MIT
// Open batches and own record slots. Enters: records that leave; leaves: packets.
#include "firmware/pe/outbox.hpp"

namespace torolux::pe {

void RecordSlots::set(const Memory& memory, const protocol::StageLayout& layout) {
  first_ = memory.at<std::byte>(layout.record_slots.address);
  count_ = layout.record_slots.count;
  own_ = protocol::own_slots(layout.stage);
  free_count_ = 0;
  for (std::uint32_t slot = own_; slot-- > 0;) free_own(static_cast<Slot>(slot));
}

Slot RecordSlots::take(Niu& niu) {
  if (free_count_ == 0) niu.fail(FaultCode::own_slots_exhausted, own_);
  return free_[--free_count_];
}

void Outbox::set(protocol::Stage stage) {
  batches_ = {};
  for (Batch& batch : batches_) batch.destination = protocol::kNobody;
  used_ = 0;
  opened_ = 0;
  most_ = protocol::records_per_packet(stage);
}

void Outbox::put(Niu& niu, RecordSlots& slots, PeNumber destination, Slot slot) {
  Batch& batch = batch_for(niu, slots, destination);
  if (batch.count == 0) {
    batch.destination = destination;
    batch.opened = opened_++;
    ++used_;
  }
  batch.slots[batch.count++] = slot;
  if (batch.count == most_) send(niu, slots, batch);
}

Outbox::Batch& Outbox::batch_for(Niu& niu, RecordSlots& slots, PeNumber destination) {
  for (Batch& batch : batches_) {
    if (batch.destination == destination) return batch;
  }
  Batch* free = nullptr;
  Batch* fullest = &batches_[0];
  for (Batch& batch : batches_) {
    if (batch.count == 0) {
      free = &batch;
    } else if (batch.count > fullest->count || (batch.count == fullest->count && batch.opened < fullest->opened)) {
      fullest = &batch;
    }
  }
  if (free != nullptr) return *free;
  send(niu, slots, *fullest);
  return *fullest;
}

void Outbox::send(Niu& niu, RecordSlots& slots, Batch& batch) {
  niu.send_records(batch.destination, std::span<const Slot>(batch.slots.data(), batch.count));
  for (std::uint32_t i = 0; i < batch.count; ++i) slots.free_own(batch.slots[i]);
  batch.count = 0;
  batch.destination = protocol::kNobody;
  --used_;
}

void Outbox::flush(Niu& niu, RecordSlots& slots) {
  for (Batch& batch : batches_) {
    if (batch.count > 0) send(niu, slots, batch);
  }
}

}  // namespace torolux::pe
