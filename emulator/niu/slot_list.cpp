// SPDX-License-Identifier: MIT
// A list of free slots, last in, first out, threaded through ProcessorState::next_free.
#include "emulator/niu/slot_list.hpp"

namespace torolux {

void set_slot_list(ProcessorState& state, const protocol::NiuWindow::Slots& slots) {
  state.slots_address = slots.address;
  state.slot_bytes = slots.bytes;
  state.own_slots = slots.own;
  state.niu_slots = state.slots_free = slots.niu;
  for (std::uint32_t i = 0; i < slots.niu; ++i) {
    state.next_free[i] = i + 1 < slots.niu ? static_cast<std::uint16_t>(i + 1) : kNoSlot;
  }
  state.first_free = slots.niu != 0 ? std::uint16_t{0} : kNoSlot;
}

std::optional<NiuFault> release_slot(ProcessorState& state, std::uint32_t slot) {
  const std::uint32_t index = slot - state.own_slots;
  if (slot < state.own_slots || index >= state.niu_slots) {
    return NiuFault{NiuFaultCode::bad_slot, {slot, state.own_slots, state.niu_slots}};
  }
  if (state.next_free[index] != kSlotInUse) return NiuFault{NiuFaultCode::slot_not_in_use, {slot, 0, 0}};
  state.next_free[index] = state.first_free;
  state.first_free = static_cast<std::uint16_t>(index);
  ++state.slots_free;
  return std::nullopt;
}

std::uint16_t take_slot(ProcessorState& state) {
  const std::uint16_t index = state.first_free;
  state.first_free = state.next_free[index];
  state.next_free[index] = kSlotInUse;
  --state.slots_free;
  return static_cast<std::uint16_t>(index + state.own_slots);
}

}  // namespace torolux
