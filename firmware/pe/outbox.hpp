// SPDX-License-Identifier: MIT
// Open batches: records that wait to leave, by destination, as lists of their slots. A record is never copied here; the
// NIU reads it from its slot when the batch is sent.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/niu/niu.hpp"
#include "firmware/protocol/stores.hpp"

namespace torolux::pe {

/// The record slots of a stage. Slots 0 .. own-1 are for records that the PE creates, the rest are the NIU's.
class RecordSlots {
 public:
  /// All slots must be free.
  void set(const Memory& memory, const protocol::StageLayout& layout);

  template <class Record>
  Record& at(Slot slot) const {
    return reinterpret_cast<Record*>(first_)[slot];
  }
  std::uint32_t count() const { return count_; }

  /// A free slot for a record of the PE's own. Fails the run where there is none.
  Slot take(Niu& niu);
  /// The record in `slot` has died or been copied out by the NIU: own slots become free again.
  void free_own(Slot slot) {
    if (slot < own_) free_[free_count_++] = slot;
  }
  bool is_own(Slot slot) const { return slot < own_; }

 private:
  std::byte* first_ = nullptr;
  std::uint32_t count_ = 0;
  std::uint32_t own_ = 0;
  std::uint32_t free_count_ = 0;
  std::array<Slot, protocol::kMostOwnSlots> free_{};
};

class Outbox {
 public:
  void set(const protocol::StageLayout& layout);
  bool empty() const { return used_ == 0; }
  /// Adds a record; sends its batch if it is now full. Destinations share batches by their lowest bits: one drives out
  /// the other's.
  void put(Niu& niu, RecordSlots& slots, PeNumber destination, Slot slot);
  void flush(Niu& niu, RecordSlots& slots);

 private:
  struct Batch {
    PeNumber destination;
    std::uint16_t count;  ///< 0: not in use
    std::array<Slot, protocol::kMostRecordsPerPacket> slots;
  };
  void send(Niu& niu, RecordSlots& slots, Batch& batch);

  std::array<Batch, protocol::kMostOpenBatches> batches_{};
  std::uint32_t used_ = 0;
  std::uint32_t mask_ = 0;
  std::uint32_t most_ = 0;  ///< records in a packet of this stage
};

}  // namespace torolux::pe
