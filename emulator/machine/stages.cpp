// SPDX-License-Identifier: MIT
// Figures of a run and of its stages. What both sides of the NIUs have counted enters; differences between stages
// leave.
#include <algorithm>
#include <string>

#include "emulator/errors.hpp"
#include "emulator/machine/emulation.hpp"
#include "emulator/niu/profile.hpp"

namespace torolux {
namespace {

/// What a processor has done between two marks.
void fill_between(PeFigures& out, const ProcessorMark& from, const ProcessorMark& to) {
  out.begin = from.clock;
  out.cycles = out.busy_cycles = to.clock - from.clock;
  for (std::size_t i = 0; i < kWaitReasons; ++i) {
    out.waits[i] = to.waits[i] - from.waits[i];
    out.busy_cycles -= out.waits[i];
  }
  out.instructions = to.instructions - from.instructions;
  out.copy_out_cycles = to.copied - from.copied;
  for (std::size_t i = 0; i < out.phase_cycles.size(); ++i) {
    out.phase_cycles[i] = to.phase_cycles[i] - from.phase_cycles[i];
  }
}

/// The names, and one for each phase that has none but cycles.
PhaseNames phases_of(const std::vector<PeFigures>& pes, const PhaseNames& names) {
  PhaseNames phases = names;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const bool used = std::any_of(pes.begin(), pes.end(), [i](const PeFigures& pe) { return pe.phase_cycles[i] != 0; });
    if (used) phases[i] = phase_name(names, i);
  }
  return phases;
}

void subtract(BusTraffic& from, const BusTraffic& before) {
  from.transfers -= before.transfers;
  from.bytes -= before.bytes;
  from.cycles -= before.cycles;
}

void subtract(LinkFigures& from, const LinkFigures& before) {
  from.packets -= before.packets;
  from.flits -= before.flits;
  from.wasted_flits -= before.wasted_flits;
  from.busy -= before.busy;
  from.stalled -= before.stalled;
}

void subtract(RouterFigures& from, const RouterFigures& before);
void subtract(KindFigures& from, const KindFigures& before);

template <class Range>
void subtract_each(Range& from, const Range& before) {
  for (std::size_t i = 0; i < from.size(); ++i) {
    if constexpr (requires { from[i] -= before[i]; }) {
      from[i] -= before[i];
    } else {
      subtract(from[i], before[i]);
    }
  }
}

void subtract(BusFigures& from, const BusFigures& before) {
  from.arbitration_cycles -= before.arbitration_cycles;
  from.data_cycles -= before.data_cycles;
  from.transfers -= before.transfers;
  subtract_each(from.users, before.users);
  subtract_each(from.kinds, before.kinds);
  subtract_each(from.from_pe, before.from_pe);
  subtract_each(from.to_pe, before.to_pe);
}

void subtract(RouterFigures& from, const RouterFigures& before) {
  subtract_each(from.links, before.links);
  subtract(from.injection, before.injection);
  subtract(from.ejection, before.ejection);
}

void subtract(PacketFigures& from, const PacketFigures& before) {
  subtract_each(from.by_hops, before.by_hops);
  subtract_each(from.bytes_by_hops, before.bytes_by_hops);
  subtract_each(from.by_latency, before.by_latency);
  subtract_each(from.by_records, before.by_records);
  subtract_each(from.bytes_by_records, before.bytes_by_records);
  from.packets -= before.packets;
  from.latency_sum -= before.latency_sum;
  from.hops -= before.hops;
  from.wasted_hops -= before.wasted_hops;
}

void subtract(KindFigures& from, const KindFigures& before) {
  from.packets -= before.packets;
  from.records -= before.records;
  from.bytes -= before.bytes;
}

/// What the network's side counts.
void subtract(MachineFigures& from, const MachineFigures& before) {
  from.now -= before.now;
  for (std::size_t pe = 0; pe < from.pes.size(); ++pe) {
    from.pes[pe].packets_sent -= before.pes[pe].packets_sent;
    from.pes[pe].packets_delivered -= before.pes[pe].packets_delivered;
    from.pes[pe].records_diverted -= before.pes[pe].records_diverted;
    from.pes[pe].copy_in_cycles -= before.pes[pe].copy_in_cycles;
  }
  subtract_each(from.routers, before.routers);
  subtract(from.packets, before.packets);
  from.link_retries -= before.link_retries;
  subtract_each(from.record_kinds, before.record_kinds);
  subtract(from.bus, before.bus);
  from.host.busy_cycles -= before.host.busy_cycles;
  subtract_each(from.host.items, before.host.items);
  subtract_each(from.host.own_cycles, before.host.own_cycles);
  from.frame_buffer_busy_cycles -= before.frame_buffer_busy_cycles;
  from.frame_buffer_message_cycles -= before.frame_buffer_message_cycles;
  from.pixels_added -= before.pixels_added;
}

}  // namespace

void Emulation::begin_stage(std::string_view name) {
  if (watch_) watch_->stage(begun_ ? host_.now() : 0, name);
  if (!begun_) {
    begun_ = true;
    stages_.front().name = name;
    return;
  }
  if (stages_.size() == kMostStages) {
    throw MachineFailure("the host program begins more than " + std::to_string(kMostStages) + " stages");
  }
  for (NiuNetworkSide& niu : nius_) niu.set_stage(static_cast<std::uint32_t>(stages_.size()));
  stages_.push_back({std::string(name), network_figures(host_.now())});
}

void Emulation::note(HostGauge gauge, double value) {
  time_line_.note(gauge, value, host_.now());
  if (pacer_ != nullptr && gauge == HostGauge::unshot) pacer_->passed(Step::round);  // told at each selection
  if (watch_) watch_->gauge(host_.now(), gauge, value);
}

void Emulation::end_watch(Cycles end) {
  if (watch_) watch_->end(end);
  if (record_watcher_ != nullptr) record_watcher_->end(end);
}

/// Of a packet that a PE sends; mostly all records are of one kind, which the sender, who had them at hand, has told.
void Emulation::count_kinds(const Block& block) {
  if (kinds_.empty()) return;
  const std::size_t bytes = block.bytes / block.records;
  const std::uint64_t first = block.kinds & 15U;
  constexpr std::uint64_t kAll = 0x1111'1111'1111'1111U;
  if (first != 0 && block.kinds == first * (kAll >> (64U - 4U * block.records))) {
    KindFigures& figures = kinds_[first - 1];
    ++figures.packets;
    figures.records += block.records;
    figures.bytes += block.records * bytes;
    return;
  }
  std::uint64_t met = 0;  // a bit for each kind
  for (std::size_t i = 0; i < block.records; ++i) {
    const std::size_t told = block.kinds >> (4 * i) & 15U;
    const std::size_t kind = told != 0 ? told - 1 : program_->record_kind(block.payload().subspan(i * bytes, bytes));
    if (kind == RecordKinds::kUnknown) throw MachineFailure("a PE sends records of another size");
    KindFigures& figures = kinds_.at(kind);
    ++figures.records;
    figures.bytes += bytes;
    if ((met >> kind & 1U) == 0) ++figures.packets;
    met |= std::uint64_t{1} << kind;
  }
}

/// The host's work since the last call ends where its clock is now.
void Emulation::note_host_busy() {
  const Cycles now = host_.now();
  const Cycles busy = host_.clock().busy(now);
  time_line_.host_was_busy(now - (busy - host_busy_), now);
  if (watch_) watch_->host_was_busy(now - (busy - host_busy_), now);
  host_busy_ = busy;
}

/// What the network's side has counted up to now.
MachineFigures Emulation::network_figures(Cycles now) {
  MachineFigures figures;
  figures.now = now;
  figures.pes.resize(pes_);
  for (unsigned pe = 0; pe < pes_; ++pe) {
    PeFigures& out = figures.pes[pe];
    out.packets_sent = parts_[pe].packets_sent;
    out.packets_delivered = parts_[pe].packets_delivered;
    out.records_diverted = host_.records_diverted(pe);
    out.record_slots_high_water = nius_[pe].slots_high_water();
    out.copy_in_cycles = nius_[pe].copy_in_cycles();
    out.receive_buffers_high_water = nius_[pe].receive_buffers_high_water();
  }
  figures.routers = torus_.router_figures(now_);
  figures.packets = torus_.packet_figures();
  figures.link_retries = torus_.link_retries();
  figures.record_kinds = kinds_;
  figures.bus = bus_.figures();
  figures.host = {host_.clock().busy(now), host_.clock().items(), host_.clock().own_cycles()};
  figures.frame_buffer_busy_cycles = controller_.busy_cycles();
  figures.frame_buffer_high_water = controller_.high_water();
  figures.frame_buffer_message_cycles = controller_.message_cycles();
  figures.pixels_added = controller_.pixels_added();
  return figures;
}

/// A PE that has taken nothing of a stage is idle in it, from when the host begins it.
void Emulation::fill_in_stages(MachineFigures& all, unsigned pe, const ProcessorMark& end) const {
  const ProcessorState& state = nius_[pe].channel().processor;
  ProcessorMark from{};
  for (std::size_t s = 0; s < stages_.size(); ++s) {
    PeFigures& out = all.stages[s].figures.pes[pe];
    const bool last = s + 1 == stages_.size();
    ProcessorMark to = s < state.stage ? state.marks[s + 1] : end;
    fill_between(out, from, to);
    if (s >= state.stage) {
      const Cycles next = last ? all.now : std::max(to.clock, stages_[s + 1].before.now);
      out.idle_at_end = next - to.clock;
      out.cycles += out.idle_at_end;
      from = end;
      from.clock = next;
    } else {
      from = to;
    }
  }
}

void Emulation::fill_in(MachineFigures& figures) {
  Cycles end = std::max(now_, host_.now());
  let_rest();
  engine_.bring_figures();
  for (unsigned pe = 0; pe < pes_; ++pe) {
    end = std::max(end, nius_[pe].channel().clock.load(std::memory_order_acquire));
  }
  if (stopped_) end = std::max(end, until_);
  figures = network_figures(end);
  figures.trace_hash = trace_hash_;
  figures.stopped = stopped_;
  for (std::size_t s = 0; s < stages_.size(); ++s) {
    const bool last = s + 1 == stages_.size();
    figures.stages.push_back({stages_[s].name, stages_[s].before.now, last ? figures : stages_[s + 1].before});
    figures.stages.back().figures.stages.clear();
    subtract(figures.stages.back().figures, stages_[s].before);
  }
  std::vector<Slices<std::uint64_t>> busy;
  for (unsigned pe = 0; pe < pes_; ++pe) {
    const ProcessorMark mark = mark_of(nius_[pe].channel());
    PeFigures& out = figures.pes[pe];
    fill_between(out, ProcessorMark{}, mark);
    out.halted = nius_[pe].waits_for() == WaitKind::halted;
    out.idle_at_end = end - mark.clock;
    out.cycles = end;
    fill_in_stages(figures, pe, mark);
    const ProcessorState& state = nius_[pe].channel().processor;
    busy.push_back(state.busy);
    busy.back().add_interval(state.busy_since, mark.clock, 1);
  }
  figures.phases = phases_of(figures.pes, phases_);
  for (StageFigures& stage : figures.stages) stage.figures.phases = figures.phases;
  note_host_busy();
  figures.time_line = time_line_.figures(end, busy);
}

}  // namespace torolux
