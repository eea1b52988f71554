// SPDX-License-Identifier: MIT
// What each event does: commands of PEs, deliveries, transfers over the bus.
#include "emulator/machine/emulation.hpp"

#include <cstring>

#include "emulator/errors.hpp"
#include "emulator/machine/faults.hpp"

namespace torolux {

namespace {

std::vector<NiuNetworkSide> make_nius(const std::vector<NiuChannel*>& channels, const MachineDescription& machine,
                                      Engine& engine) {
  std::vector<NiuNetworkSide> nius;
  const auto pes = static_cast<unsigned>(channels.size());
  for (unsigned pe = 0; pe < pes; ++pe) nius.emplace_back(*channels[pe], pe, pes, machine, engine.waker(pe));
  return nius;
}

}  // namespace

Emulation::Emulation(const MachineSetup& setup, const std::vector<NiuChannel*>& channels, const Image& image,
                     Engine& engine, HostProgram& program)
    : pes_(static_cast<std::uint32_t>(channels.size())),
      image_(image),
      engine_(engine),
      program_(program),
      events_(3 * std::size_t{pes_} + 4),
      times_{BoundTree(pes_, kCommandCycles), BoundTree(pes_, kNever)},
      nius_(make_nius(channels, setup.description, engine)),
      parts_(pes_),
      jitter_(setup.description.jitter.seed, setup.description.jitter.cycles),
      torus_(TorusShape(setup.columns, setup.rows), setup.description.torus, jitter_, events_,
             {.routers = pes_, .arbiters = 2 * pes_ + 3}, pool_, *this),
      bus_(pes_, setup.description.bus, jitter_, events_, 2 * pes_, pool_, *this),
      controller_(setup.description.frame_buffer, setup.frame_width, setup.frame_height, setup.frame_layers, events_,
                  2 * pes_ + 2, pool_),
      host_(setup.description.host, program, nius_, events_, 2 * pes_ + 1, pool_) {}

void Emulation::handle(const Event& event) {
  switch (event.kind) {
    case EventKind::command:
      command(event.actor);
      break;
    case EventKind::arrive:
    case EventKind::head:
    case EventKind::tail:
    case EventKind::line:
    case EventKind::arbitrate:
      torus_.handle(event);
      break;
    case EventKind::deliver:
      deliver(event.actor, event.block);
      break;
    case EventKind::bus_done:
      bus_done(event.block);
      break;
    case EventKind::host_queue:
      host_.enqueue(event.actor, event.block);
      update_host();
      break;
    case EventKind::host_step:
      host_.step(event.time);
      break;
    case EventKind::pixels_done:
      pixels_done(event.block);
      break;
  }
}

void Emulation::command(unsigned pe) {
  NiuNetworkSide& niu = nius_[pe];
  const PendingCommand command = niu.next_command();
  if (command.released != 0) niu.release_slots(command.released);
  switch (command.kind) {
    case CommandKind::send_records: {
      Block& block = pool_[command.block];
      block.flits = torus_.flits(block.bytes);
      torus_.inject(pe, command.block, now_);
      break;
    }
    case CommandKind::send_message:
      parts_[pe].outgoing.push(pool_, command.block);
      update_outgoing(pe);
      bus_.try_grant(now_);
      break;
    case CommandKind::release:
      break;
    case CommandKind::received:
      niu.release_control_buffer();
      host_.room_changed(pe);
      update_host();
      break;
    case CommandKind::set_slots: {
      SlotsCommand slots{};
      std::memcpy(&slots, pool_[command.block].data.data(), sizeof slots);
      if (niu.slots_used() != 0) {
        throw MachineFailure(describe_fault(pe, NiuFault{NiuFaultCode::slots_in_use, {niu.slots_used(), 0, 0}}));
      }
      niu.set_slots(slots.niu);
      pool_.give_back(command.block);
      slots_changed(pe);
      break;
    }
    case CommandKind::halt:
      parts_[pe].halted = true;
      break;
    case CommandKind::fail:
      fail_program(pe, command.block);
    case CommandKind::fault:
      fail_niu(pe, command.block);
  }
  if (command.released != 0) slots_changed(pe);
}

void Emulation::fail_program(unsigned pe, BlockIndex block) {
  protocol::Fault fault{};
  std::memcpy(&fault, pool_[block].data.data(), sizeof fault);
  throw MachineFailure(describe_fault(pe, fault, image_) + " (cycle " + std::to_string(now_) + ")");
}

void Emulation::fail_niu(unsigned pe, BlockIndex block) {
  NiuFault fault{};
  std::memcpy(&fault, pool_[block].data.data(), sizeof fault);
  throw MachineFailure(describe_fault(pe, fault) + " (cycle " + std::to_string(now_) + ")");
}

/// Slots of a PE's NIU have become free: packets may leave the torus, the host may send records.
void Emulation::slots_changed(unsigned pe) {
  torus_.try_ejection(pe, now_);
  host_.room_changed(pe);
  update_host();
}

// ---- Torus ----

void Emulation::injected(unsigned pe, Cycles tail) {
  ++parts_[pe].packets_sent;
  nius_[pe].left_torus_queue(tail, times_);
}

/// Slots if there are enough; otherwise the divert buffer, once it is free.
bool Emulation::accept(unsigned pe, BlockIndex block) {
  const std::uint32_t records = pool_[block].records;
  if (nius_[pe].has_slots(records)) {
    nius_[pe].reserve_slots(records);
    host_.room_changed(pe);
    bus_.set_ready(BusRequester::host(), host_.ready());
    return true;
  }
  if (parts_[pe].diverting != kNoBlock) return false;
  parts_[pe].diverting = block;
  return true;
}

void Emulation::deliver(unsigned pe, BlockIndex block) {
  if (pool_[block].copy != Copy::good) return drop(pe, block);
  ++parts_[pe].packets_delivered;
  if (parts_[pe].diverting != block) return nius_[pe].deliver(block, now_, pool_, times_);
  bus_.set_ready(BusRequester::divert(pe), true);
  bus_.try_grant(now_);
}

/// The tail of a packet has come and its CRC is bad. What `accept` reserved for it is free again.
void Emulation::drop(unsigned pe, BlockIndex block) {
  if (parts_[pe].diverting == block) {
    parts_[pe].diverting = kNoBlock;
    torus_.try_ejection(pe, now_);
  } else {
    nius_[pe].release_slots(pool_[block].records);
    slots_changed(pe);
  }
  pool_.give_back(block);
}

// ---- Bus ----

/// A PE may send once its first message has room where it goes: host memory always has.
void Emulation::update_outgoing(unsigned pe) {
  const BlockQueue& queue = parts_[pe].outgoing;
  const bool ready = !queue.empty() && (pool_[queue.front()].destination == protocol::kHost || controller_.has_place());
  bus_.set_ready(BusRequester::outgoing(pe), ready);
}

void Emulation::update_host() {
  bus_.set_ready(BusRequester::host(), host_.ready());
  bus_.try_grant(now_);
}

BlockIndex Emulation::take(BusRequester requester, Cycles now) {
  if (requester.is_host()) {
    const BlockIndex block = host_.take();
    bus_.set_ready(requester, host_.ready());
    return block;
  }
  const unsigned pe = requester.pe();
  if (requester.is_divert()) {
    bus_.set_ready(requester, false);
    return parts_[pe].diverting;
  }
  const BlockIndex block = parts_[pe].outgoing.pop(pool_);
  if (pool_[block].destination == protocol::kFrameBuffer) {
    controller_.reserve_place();
    if (!controller_.has_place()) {
      for (unsigned other = 0; other < pes_; ++other) update_outgoing(other);
    }
  }
  update_outgoing(pe);
  nius_[pe].left_bus_queue(now, times_);
  return block;
}

void Emulation::bus_done(BlockIndex index) {
  bus_.transfer_done();
  const Block& block = pool_[index];
  const bool from_host_queue = block.source == protocol::kHost;
  if (block.records != 0 && !from_host_queue && parts_[block.destination].diverting == index) {
    parts_[block.destination].diverting = kNoBlock;
    host_.arrive(index, now_);
    torus_.try_ejection(block.destination, now_);
  } else if (block.records != 0 || from_host_queue) {
    nius_[block.destination].deliver(index, now_, pool_, times_);
  } else if (block.destination == protocol::kFrameBuffer) {
    controller_.arrive(index, now_);
  } else {
    host_.arrive(index, now_);
  }
  bus_.try_grant(now_);
}

void Emulation::pixels_done(BlockIndex block) {
  const bool was_full = !controller_.has_place();
  controller_.add_pixels(block);
  if (!was_full) return;
  for (unsigned pe = 0; pe < pes_; ++pe) update_outgoing(pe);
  bus_.try_grant(now_);
}

}  // namespace torolux
