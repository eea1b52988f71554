// SPDX-License-Identifier: MIT
// The loop of a PE: handle what has come, work as long as there is work and credit, else send what waits and sleep.
#include "firmware/pe/pe.hpp"

namespace torolux::pe {
namespace {

using protocol::ArrivalKind;

/// Before it sleeps.
void flush(Pe& pe, Niu& niu) {
  if (pe.outbox.empty() && pe.results.empty()) return;
  const PhaseMark<Phase::flush> mark(niu);
  pe.outbox.flush(niu, pe.slots);
  pe.results.flush(niu);
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
    const bool busy = can_work(pe);
    if (busy) {
      work(pe, niu);
    } else {
      flush(pe, niu);
    }
    const NiuWindow::Arrival* arrival = busy ? &niu.receive_due() : &niu.receive();
    for (; arrival->kind != ArrivalKind::none; arrival = busy ? &niu.receive_due() : &niu.receive_more()) {
      if (arrival->kind == ArrivalKind::records) {
        handle_records(pe, niu, *arrival);
      } else if (!handle_message(pe, niu)) {
        return;
      }
    }
    if (pe.state == State::running) report_work(pe, niu);
  }
}

void end_record(Pe& pe, Niu& niu, Slot slot) {
  if (pe.slots.is_own(slot)) {
    pe.slots.free_own(slot);
  } else {
    niu.release(slot);
  }
  ++pe.credits.in_hand;
}

}  // namespace torolux::pe
