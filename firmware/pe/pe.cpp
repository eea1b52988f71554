// SPDX-License-Identifier: MIT
// The loop of a PE: sleep until woken, handle what has gathered, send what waits.
#include "firmware/pe/pe.hpp"

namespace torolux::pe {
namespace {

using protocol::ArrivalKind;

void flush(Pe& pe, Niu& niu) {
  const PhaseMark<Phase::flush> mark(niu);
  pe.outbox.flush(niu, pe.slots);
  pe.homecoming.flush(niu);
}

void handle_records(Pe& pe, Niu& niu, const NiuWindow::Arrival& arrival) {
  if (pe.state != State::running) niu.fail(FaultCode::unexpected_message, 0, static_cast<std::uint32_t>(pe.state));
  const auto slots = arrival.slots;  // the next HINT may bring another arrival into the window
  const std::uint32_t count = arrival.count;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (pe.scene.layout.stage == protocol::Stage::radiosity) {
      handle_radiosity_record(pe, niu, slots[i]);
    } else {
      handle_ray(pe, niu, slots[i]);
    }
  }
}

}  // namespace

void run_pe(Pe& pe, Niu& niu) {
  const PhaseMark<Phase::dispatch> mark(niu);
  for (;;) {
    const NiuWindow::Arrival* arrival = &niu.receive();
    for (; arrival->kind != ArrivalKind::none; arrival = &niu.receive_more()) {
      if (arrival->kind == ArrivalKind::records) {
        handle_records(pe, niu, *arrival);
      } else if (!handle_message(pe, niu)) {
        return;
      }
    }
    if (!pe.outbox.empty() || !pe.homecoming.empty()) flush(pe, niu);
  }
}

void end_record(Pe& pe, Niu& niu, Slot slot) {
  if (pe.slots.is_own(slot)) {
    pe.slots.free_own(slot);
  } else {
    niu.release(slot);
  }
  pe.homecoming.add_credits(niu, 1);
}

}  // namespace torolux::pe
