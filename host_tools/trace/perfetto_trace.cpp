// SPDX-License-Identifier: MIT
// Which track has what. What is told outside the window, of PEs that are not shown, or once the trace is full, is left
// out.
#include "host_tools/trace/perfetto_trace.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host_tools/report/version.hpp"

namespace torolux {
namespace {

// Tracks by number. Those of a PE: kPes + pe * kTracksOfPe + ...
constexpr TrackId kMachine = 1, kStages = 2, kHost = 3, kBus = 4, kFrameBuffer = 5, kRounds = 6, kGauges = 8,
                  kCounters = 16;
constexpr TrackId kRows = 0x100, kPes = 0x2'0000, kTracksOfPe = 8;
constexpr TrackId kStates = 0, kPackets = 1, kFirstCounter = 2;

struct CounterName {
  std::string_view name, unit;
};
constexpr std::array<CounterName, 5> kPeCounterNames = {{{"outgoing queue, torus", "packets"},
                                                         {"outgoing queue, bus", "messages"},
                                                         {"record slots in use", "slots"},
                                                         {"receive buffers in use", "packets"},
                                                         {"busiest outgoing link", "%"}}};
constexpr std::array<CounterName, 6> kMachineCounterNames = {{{"packets in the torus", "packets"},
                                                              {"messages at the FBC", "messages"},
                                                              {"messages at the host", "messages"},
                                                              {"bus use", "%"},
                                                              {"host use", "%"},
                                                              {"FBC use", "%"}}};
constexpr std::array<CounterName, kHostGauges> kGaugeNames = {{{"records in flight", "records"}, {"unshot", "of 1"}}};

/// What is written for a slice, sample or instant is less.
constexpr std::uint64_t kMostOfEvent = 192;
/// Of an arrow's end, which finds room even in a full trace.
constexpr std::uint64_t kMostOfArrowEnd = 160;
/// Of what is said when the trace is full.
constexpr std::uint64_t kMostOfLast = 512;

TrackId track_of(unsigned pe, TrackId which) {
  return kPes + pe * kTracksOfPe + which;
}

/// With as many digits as the greatest: so that sorting by name sorts by number.
std::string padded(unsigned number, unsigned greatest) {
  std::string text = std::to_string(number);
  const std::size_t digits = std::to_string(greatest).size();
  return std::string(digits - std::min(digits, text.size()), '0') + text;
}

/// Equal for the same packet in every run, and as if by chance.
std::uint64_t mixed(std::uint64_t number) {
  number = (number ^ (number >> 31U)) * 0x9E37'79B9'7F4A'7C15U;
  number = (number ^ (number >> 29U)) * 0xBF58'476D'1CE4'E5B9U;
  return number ^ (number >> 32U);
}

}  // namespace

PerfettoTrace::PerfettoTrace(TraceChoice choice, PerfettoPackets::Take take)
    : choice_(std::move(choice)), packets_(std::move(take)) {}

/// Exact where a cycle takes whole nanoseconds.
std::uint64_t PerfettoTrace::nanoseconds(Cycles time) const {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  return time / hertz_ * kSecond + time % hertz_ * kSecond / hertz_;
}

/// For something that is told at `time`, of the window. Once there is none, all that follows is left out.
bool PerfettoTrace::room(Cycles time, std::uint64_t bytes) {
  if (full_at_) return false;
  if (packets_.bytes() + kMostOfEvent + bytes + (arrows_.size() + 1) * kMostOfArrowEnd + kMostOfLast <=
      choice_.most_bytes)
    return true;
  full_at_ = time;
  return false;
}

// ---- Tracks ----

void PerfettoTrace::begin(const WatchedMachine& machine) {
  const unsigned pes = machine.columns * machine.rows;
  columns_ = machine.columns;
  phases_ = machine.phases;
  hertz_ =
      std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(machine.description.processor.clock_hertz)));
  shown_.assign(pes, choice_.pes.empty());
  for (const unsigned pe : choice_.pes) shown_.at(pe) = true;
  pes_.resize(pes);
  pe_counters_.resize(pes);
  make_machine_tracks();
  tell_settings(machine);
  for (unsigned row = 0; row < machine.rows; ++row) {
    const auto first = shown_.begin() + row * columns_;
    if (std::find(first, first + columns_, true) == first + columns_ || !room(0)) continue;
    packets_.make_track(kRows + row, 0, "row " + padded(row, machine.rows - 1), row + 1);
    for (unsigned pe = row * columns_; pe < (row + 1) * columns_; ++pe) make_pe_tracks(pe);
  }
}

void PerfettoTrace::make_machine_tracks() {
  packets_.make_track(kMachine, 0, "machine", 0);
  std::uint32_t rank = 0;
  packets_.make_track(kStages, kMachine, "stage", rank++);
  packets_.make_track(kRounds, kMachine, "rounds", rank++);
  packets_.make_track(kHost, kMachine, "host", rank++);
  packets_.make_track(kBus, kMachine, "bus", rank++);
  packets_.make_track(kFrameBuffer, kMachine, "frame buffer controller (FBC)", rank++);
  for (std::size_t i = 0; i < kHostGauges; ++i)
    packets_.make_counter(kGauges + i, kMachine, kGaugeNames[i].name, kGaugeNames[i].unit, rank++);
  for (std::size_t i = 0; i < kMachineCounters; ++i)
    packets_.make_counter(kCounters + i, kMachine, kMachineCounterNames[i].name, kMachineCounterNames[i].unit, rank++);
}

void PerfettoTrace::make_pe_tracks(unsigned pe) {
  const std::uint64_t all = (kPeCounters + 2) * kMostOfEvent;
  if (!shown_[pe]) return;
  if (!room(0, all)) {
    shown_[pe] = false;
    return;
  }
  const unsigned x = pe % columns_, y = pe / columns_;
  const TrackId states = track_of(pe, kStates);
  packets_.make_track(states, kRows + y,
                      "PE " + padded(pe, static_cast<unsigned>(pes_.size()) - 1) + " (x " + std::to_string(x) + ", y " +
                          std::to_string(y) + ")",
                      x);
  if (choice_.arrows != 0) packets_.make_track(track_of(pe, kPackets), states, "packets with arrows", 0);
  for (std::uint32_t i = 0; i < kPeCounters; ++i)
    packets_.make_counter(track_of(pe, kFirstCounter + i), states, kPeCounterNames[i].name, kPeCounterNames[i].unit,
                          i + 1);
}

/// Nothing that hangs on this computer: the trace is the same on any.
void PerfettoTrace::tell_settings(const WatchedMachine& machine) {
  const bool whole = choice_.from == 0 && choice_.to == ~Cycles{0};
  const std::array<Annotation, 7> settings = {
      {{"torolux", std::string(kVersion)},
       {"PEs", std::to_string(machine.columns) + "x" + std::to_string(machine.rows)},
       {"cycles per second", std::to_string(hertz_)},
       {"time", "virtual; 1 cycle = " + std::to_string(1e9 / static_cast<double>(hertz_)) + " ns"},
       {"grain", std::to_string(Cycles{1} << choice_.grain_shift) + " cycles are shown as one state"},
       {"window", whole ? "all" : std::to_string(choice_.from) + ":" + std::to_string(choice_.to) + " cycles"},
       {"arrows", choice_.arrows == 0 ? "none" : "of one packet in " + std::to_string(choice_.arrows)}}};
  packets_.instant(kStages, nanoseconds(choice_.from), "settings of this trace", settings);
}

// ---- States ----

/// name: of the next slice; 0: none.
void PerfettoTrace::change(Lane& lane, TrackId track, Cycles time, NameId name) {
  last_ = std::max(last_, time);
  const Cycles begin = std::max(lane.since, choice_.from);
  const Cycles end = std::min(time, choice_.to);
  if (lane.name != 0 && begin < end && room(begin))
    packets_.slice(track, nanoseconds(begin), nanoseconds(end), lane.name);
  lane = {name, time};
}

NameId PerfettoTrace::name_of_state(PeState state) {
  NameId& name = state_names_.at(state);
  if (name == 0) name = packets_.name(name_of_pe_state(state, phases_));
  return name;
}

void PerfettoTrace::pe_state(unsigned pe, Cycles begin, PeState state) {
  if (shows(pe)) change(pes_[pe], track_of(pe, kStates), begin, name_of_state(state));
}

void PerfettoTrace::bus_state(Cycles begin, std::size_t state) {
  change(bus_, kBus, begin, state == kBusIdle ? 0 : packets_.name(kBusKindNames.at(state)));
}

void PerfettoTrace::host_state(Cycles begin, bool busy) {
  change(host_, kHost, begin, busy ? packets_.name("works") : 0);
}

void PerfettoTrace::frame_buffer_state(Cycles begin, bool busy) {
  change(frame_buffer_, kFrameBuffer, begin, busy ? packets_.name("adds pixels") : 0);
}

/// Of a stage or round, of which there may be many: 0 where the trace is full.
NameId PerfettoTrace::name_of_part(Cycles begin, std::string_view name) {
  return room(begin) ? packets_.name(name) : 0;
}

void PerfettoTrace::stage(Cycles begin, std::string_view name) {
  change(stage_, kStages, begin, name_of_part(begin, name));
  change(rounds_, kRounds, begin, 0);
}

// ---- Counters ----

void PerfettoTrace::gauge(Cycles begin, HostGauge gauge, double value) {
  last_ = std::max(last_, begin);
  if (in_window(begin) && room(begin))
    packets_.counter(kGauges + static_cast<std::size_t>(gauge), nanoseconds(begin), value);
  // It is told once for each choice of who shoots next, and is 0 when there is nothing left.
  if (gauge != HostGauge::unshot || value <= 0) return;
  ++round_;
  change(rounds_, kRounds, begin, name_of_part(begin, "round " + std::to_string(round_)));
}

/// A value holds until the next one: what has not changed is not said again.
void PerfettoTrace::sample(CounterLane& lane, TrackId track, Cycles time, std::uint64_t value) {
  if ((lane.known && lane.value == value) || !in_window(time) || !room(time)) return;
  lane = {value, true};
  packets_.counter(track, nanoseconds(time), value);
}

void PerfettoTrace::counters(Cycles time, unsigned pe, const PeCounters& counters) {
  if (!shows(pe)) return;
  const std::array<std::uint32_t, kPeCounters> values = {
      counters.torus_queue, counters.bus_queue, counters.record_slots, counters.receive_buffers, counters.link_use};
  for (std::size_t i = 0; i < kPeCounters; ++i)
    sample(pe_counters_[pe][i], track_of(pe, kFirstCounter + i), time, values[i]);
}

void PerfettoTrace::counters(Cycles time, const MachineCounters& counters) {
  last_ = std::max(last_, time);
  const std::array<std::uint32_t, kMachineCounters> values = {counters.torus_packets, counters.frame_buffer_messages,
                                                              counters.host_messages, counters.bus_use,
                                                              counters.host_use,      counters.frame_buffer_use};
  for (std::size_t i = 0; i < kMachineCounters; ++i) sample(machine_counters_[i], kCounters + i, time, values[i]);
}

// ---- Arrows ----

/// Sampled by the packet's number, so the same ones in every run.
bool PerfettoTrace::followed(const PacketName& packet) const {
  return choice_.arrows != 0 && shows(packet.source) && shows(packet.destination) &&
         mixed(packet.number) % choice_.arrows == 0;
}

void PerfettoTrace::sent(Cycles time, const PacketName& packet) {
  if (!in_window(time) || !followed(packet) || !room(time)) return;
  const std::array<Annotation, 2> annotations = {
      {{"to PE", std::to_string(packet.destination)}, {"records", std::to_string(packet.records)}}};
  packets_.arrow(track_of(packet.source, kPackets), nanoseconds(time), "sent", packet.number + 1, ArrowEnd::begins,
                 annotations);
  arrows_.emplace(packet.number, packet);
}

void PerfettoTrace::received(Cycles time, const PacketName& packet) {
  if (arrows_.empty() || arrows_.erase(packet.number) == 0) return;
  end_arrow(time, packet.destination, packet.number, "received", packet);
}

/// Also beyond the window, and in a full trace: each arrow has both ends.
void PerfettoTrace::end_arrow(Cycles time, unsigned pe, std::uint64_t number, std::string_view name,
                              const PacketName& packet) {
  const std::array<Annotation, 1> annotations = {{{"from PE", std::to_string(packet.source)}}};
  packets_.arrow(track_of(pe, kPackets), nanoseconds(time), name, number + 1, ArrowEnd::ends, annotations);
}

// ---- The end ----

void PerfettoTrace::end(Cycles time) {
  last_ = std::max(last_, time);
  finish();
}

void PerfettoTrace::finish() {
  if (std::exchange(finished_, true)) return;
  for (unsigned pe = 0; pe < pes_.size(); ++pe) {
    if (shown_[pe]) change(pes_[pe], track_of(pe, kStates), last_, 0);
  }
  change(bus_, kBus, last_, 0);
  change(host_, kHost, last_, 0);
  change(frame_buffer_, kFrameBuffer, last_, 0);
  change(stage_, kStages, last_, 0);
  change(rounds_, kRounds, last_, 0);
  for (const auto& [number, packet] : arrows_) end_arrow(last_, packet.source, number, "still on its way", packet);
  arrows_.clear();
  if (full_at_) {
    const std::array<Annotation, 1> annotations = {{{"left out from cycle", std::to_string(*full_at_)}}};
    packets_.instant(kStages, nanoseconds(std::min(last_, choice_.to)), "the trace was full (--trace-limit)",
                     annotations);
  }
  packets_.flush();
}

}  // namespace torolux
