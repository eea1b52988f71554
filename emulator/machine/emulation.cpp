// SPDX-License-Identifier: MIT
// What each event does: commands of PEs, deliveries, transfers over the bus.
#include "emulator/machine/emulation.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "emulator/errors.hpp"
#include "emulator/machine/faults.hpp"
#include "firmware/protocol/messages.hpp"

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

namespace {

/// Attention at least this often, by wall time [s].
constexpr double kAttendSeconds = 0.05;

RecordPacket packet_of(const Block& block) {
  return {block.number, block.source, block.destination, block.bytes / std::max<std::size_t>(1, block.records),
          block.payload()};
}

}  // namespace

Emulation::Emulation(const MachineSetup& setup, const std::vector<NiuChannel*>& channels, CallStacks& stacks,
                     Engine& engine, HostProgram& program, PhaseNames phases)
    : pes_(static_cast<std::uint32_t>(channels.size())),
      stacks_(stacks),
      phases_(std::move(phases)),
      engine_(engine),
      program_(&program),
      events_(3 * std::size_t{pes_} + 4),
      times_{BoundTree(pes_, kCommandCycles), BoundTree(pes_, kNever)},
      channels_(channels),
      nius_(make_nius(channels, setup.description, engine)),
      parts_(pes_),
      jitter_(setup.description.jitter.seed, setup.description.jitter.cycles),
      torus_(TorusShape(setup.columns, setup.rows), setup.description.torus, jitter_, events_,
             {.routers = pes_, .arbiters = 2 * pes_ + 3}, pool_, *this),
      bus_(pes_, setup.description, jitter_, events_, 2 * pes_, 3 * pes_ + 3, pool_, *this),
      controller_(setup.description.frame_buffer, setup.frame_width, setup.frame_height, setup.frame_layers, events_,
                  2 * pes_ + 2, pool_),
      host_(setup.description, program, pes_, events_, 2 * pes_ + 1, pool_),
      signal_cycles_(setup.description.signal_cycles()),
      record_watcher_(setup.record_watcher),
      pacer_(setup.pacer),
      attend_seconds_(std::min(kAttendSeconds, setup.progress_seconds)),
      until_(setup.until != 0 ? setup.until : kNever) {
  for (NiuChannel* channel : channels_) channel->until = setup.until;
  cycles_per_pixel_ = setup.description.frame_buffer.cycles_per_pixel;
  events_.watch(this);
  torus_.watch_hops(setup.hop_watcher);
  if (setup.watcher != nullptr || setup.until != 0) torus_.keep_to_time();
  for (const std::string_view name : program.record_kinds()) kinds_.push_back({std::string(name)});
  lend_to_near_pes();
  stages_.push_back({"run", network_figures(0)});
  if (setup.watcher == nullptr) return;
  watch_.emplace(*setup.watcher, WatchedMachine{setup.description, setup.columns, setup.rows, phases_}, nius_, torus_,
                 WatchedActors{[this](unsigned pe) { return parts_[pe].outgoing.size(); },
                               [this] { return controller_.waiting(); },
                               [this] { return static_cast<std::uint32_t>(host_.inbox()); }});
}

/// What processors in this process send stays where they put it, and they tell the kinds of records.
void Emulation::lend_to_near_pes() {
  for (NiuChannel* channel : channels_) {
    if (channel->near == 0) continue;
    channel->payloads = &pool_.payloads();
    channel->record_kinds = kinds_.empty() ? nullptr : program_;
  }
}

void Emulation::handle(const Event& event) {
  switch (event.kind) {
    case EventKind::command:
      command(event.actor, PendingCommand(event, pool_));
      break;
    case EventKind::arrive:
    case EventKind::advanced:
    case EventKind::head:
    case EventKind::tail:
    case EventKind::line:
    case EventKind::arbitrate:
      torus_.handle(event);
      break;
    case EventKind::deliver:
      deliver(event.actor, event.block);
      break;
    case EventKind::copied:
      copied(event.actor, event.block, event.port != 0);
      break;
    case EventKind::bus_request:
    case EventKind::bus_place:
    case EventKind::bus_arbitrate:
      bus_.handle(event);
      break;
    case EventKind::bus_done:
      bus_done(event.block);
      break;
    case EventKind::host_queue:
      host_queue(event.actor, event.block);
      break;
    case EventKind::slots_asked:
      slots_asked(event.actor, static_cast<HostQueue>(event.port), event.block);
      break;
    case EventKind::slots_granted:
      host_.slots_granted(event.actor, static_cast<HostQueue>(event.port));
      update_host();
      break;
    case EventKind::control_free:
      host_.control_buffer_free(event.actor);
      update_host();
      break;
    case EventKind::host_step:
      host_.step();
      note_host_busy();
      break;
    case EventKind::pixels_done:
      pixels_done(event.block);
      break;
  }
}

/// Nearly all commands are known long before. What each touches has mostly left the caches since its PE ran last.
void Emulation::soon(const Event& event) {
  if (event.kind != EventKind::command) return;
  const unsigned pe = event.actor;
  nius_[pe].fetch_ahead();
  torus_.fetch_ahead(pe);
  __builtin_prefetch(&parts_[pe], 1);
  if (const BlockIndex block = PendingCommand::block_of(event); block != kNoBlock) pool_.fetch_ahead(block);
}

void Emulation::coming(unsigned pe) {
  nius_[pe].fetch_ahead();
  __builtin_prefetch(&parts_[pe], 1);
}

void Emulation::command(unsigned pe, const PendingCommand& command) {
  NiuNetworkSide& niu = nius_[pe];
  if (command.released != 0) niu.release_slots(command.released);
  switch (command.kind) {
    case CommandKind::send_records: {
      niu.fetch_departures_ahead();
      Block& block = pool_[command.block];
      block.flits = torus_.flits(block.bytes);
      count_kinds(block);
      if (watch_) watch_->sent(now_, block);
      if (record_watcher_ != nullptr) record_watcher_->sent(now_, packet_of(block));
      torus_.inject(pe, command.block, now_);
      break;
    }
    case CommandKind::send_message:
      send_message(pe, command.block);
      break;
    case CommandKind::release:
      break;
    case CommandKind::received:
      niu.release_control_buffer();
      if (!signal(EventKind::control_free, pe, 0, 0)) {
        host_.control_buffer_free(pe);
        update_host();
      }
      break;
    case CommandKind::set_slots: {
      SlotsCommand slots{};
      std::memcpy(&slots, pool_[command.block].payload().data(), sizeof slots);
      if (niu.slots_used() != 0) {
        return fail(describe_fault(pe, NiuFault{NiuFaultCode::slots_in_use, {niu.slots_used(), 0, 0}}, stacks_), "");
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
      break;
    case CommandKind::fault:
      fail_niu(pe, command.block);
      break;
  }
  if (command.released != 0) slots_changed(pe);
}

/// What comes after a failure nobody reads any more.
void Emulation::send_message(unsigned pe, BlockIndex block) {
  if (pool_[block].destination == protocol::kHost) {
    if (!failure_.empty()) return pool_.give_back(block);
    ++messages_to_host_;
  }
  parts_[pe].outgoing.push(pool_, block);
  bus_.request(BusRequester::outgoing(pe), first_request(pe), now_);
}

// ---- Failures ----

void Emulation::fail_program(unsigned pe, BlockIndex block) {
  protocol::Fault fault{};
  std::memcpy(&fault, pool_[block].payload().data(), sizeof fault);
  if (!failure_.empty()) return;
  const bool trap = static_cast<protocol::FaultCode>(fault.code) == protocol::FaultCode::trap;
  fail(describe_fault(pe, fault, stacks_), trap ? stacks_.of_trap(pe, fault.detail[1]) : stacks_.of_pe(pe));
}

void Emulation::fail_niu(unsigned pe, BlockIndex block) {
  NiuFault fault{};
  std::memcpy(&fault, pool_[block].payload().data(), sizeof fault);
  if (!failure_.empty()) return;
  fail(describe_fault(pe, fault, stacks_), calls_to(pe, fault, stacks_));
}

/// Of several, the first in virtual time counts. calls: that led there. The machine goes on until all that PEs had sent
/// the host before is read: it may say why.
void Emulation::fail(std::string text, const std::string& calls) {
  if (failure_.empty()) failure_ = std::move(text) + " (cycle " + std::to_string(now_) + ")" + calls;
}

void Emulation::end_if_failed() const {
  if (!failure_.empty() && host_.messages_read() == messages_to_host_) throw MachineFailure(failure_);
}

/// Slots of a PE's NIU have become free: packets may leave the torus, the host may send records.
void Emulation::slots_changed(unsigned pe) {
  torus_.try_ejection(pe, now_);
  grant_slots(pe);
}

// ---- Slots for the host's packets ----

/// A signal between host and NIU is on its way. False: it is there at once, and no event.
bool Emulation::signal(EventKind kind, unsigned pe, std::uint8_t port, std::uint32_t value) {
  if (signal_cycles_ == 0) return false;
  events_.push(now_ + signal_cycles_, pes_ + pe, kind, static_cast<std::uint16_t>(pe), port, value);
  return true;
}

/// The first packet of one of the host's queues, if it has just become that.
void Emulation::ask_for_slots(unsigned pe, HostQueue queue) {
  const std::uint32_t records = host_.ask_for_slots(pe, queue);
  if (records == 0 || signal(EventKind::slots_asked, pe, static_cast<std::uint8_t>(queue), records)) return;
  slots_asked(pe, queue, records);
}

void Emulation::slots_asked(unsigned pe, HostQueue queue, std::uint32_t records) {
  nius_[pe].ask_for_slots(queue, records);
  grant_slots(pe);
}

void Emulation::grant_slots(unsigned pe) {
  while (const auto queue = nius_[pe].grant_slots()) {
    if (signal(EventKind::slots_granted, pe, static_cast<std::uint8_t>(*queue), 0)) continue;
    host_.slots_granted(pe, *queue);
    update_host();
  }
}

// ---- Torus ----

void Emulation::injected(unsigned pe, Cycles tail) {
  ++parts_[pe].packets_sent;
  nius_[pe].left_torus_queue(tail, times_);
}

/// Slots if there are enough, and a buffer to wait in until it is copied there; without slots the divert buffer, once
/// it is free.
bool Emulation::accept(unsigned pe, BlockIndex block) {
  NiuNetworkSide& niu = nius_[pe];
  const std::uint32_t records = pool_[block].records;
  if (niu.has_slots(records)) {
    if (!niu.has_receive_buffer()) return false;
    niu.reserve_slots(records);
    niu.reserve_receive_buffer();
    niu.fetch_arrivals_ahead();
    return true;
  }
  if (parts_[pe].diverting != kNoBlock) return false;
  parts_[pe].diverting = block;
  return true;
}

void Emulation::deliver(unsigned pe, BlockIndex block) {
  if (pool_[block].copy != Copy::good) return drop(pe, block);
  ++parts_[pe].packets_delivered;
  time_line_.delivered(now_);
  if (parts_[pe].diverting != block) return copy_in(pe, block, false);
  bus_.request(BusRequester::divert(pe), BusRequest::room, now_);
}

/// A packet lies whole in a buffer of its NIU.
void Emulation::copy_in(unsigned pe, BlockIndex block, bool from_bus) {
  const Cycles end = nius_[pe].copy_in(pool_[block].bytes, now_);
  if (end == now_) return copied(pe, block, from_bus);
  events_.push(end, pes_ + pe, EventKind::copied, static_cast<std::uint16_t>(pe), from_bus ? 1 : 0, block);
}

void Emulation::copied(unsigned pe, BlockIndex block, bool from_bus) {
  if (watch_) watch_->received(now_, pool_[block]);
  if (pacer_ != nullptr) pacer_->passed(Step::packet);
  if (record_watcher_ != nullptr) record_watcher_->received(now_, packet_of(pool_[block]));
  nius_[pe].deliver(block, now_, pool_, times_);
  if (from_bus) {
    nius_[pe].release_bus_buffer();
    grant_slots(pe);
  } else {
    nius_[pe].release_receive_buffer();
    torus_.try_ejection(pe, now_);
  }
}

/// The tail of a packet has come and its CRC is bad. What `accept` reserved for it is free again.
void Emulation::drop(unsigned pe, BlockIndex block) {
  if (parts_[pe].diverting == block) {
    parts_[pe].diverting = kNoBlock;
    torus_.try_ejection(pe, now_);
  } else {
    nius_[pe].release_slots(pool_[block].records);
    nius_[pe].release_receive_buffer();
    slots_changed(pe);
  }
  pool_.give_back(block);
}

}  // namespace torolux
