// SPDX-License-Identifier: MIT
// What a watched machine tells enters; a trace for ui.perfetto.dev leaves, piece by piece. docs/trace.md says what is
// on which track.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "emulator/trace/watcher.hpp"
#include "host_tools/trace/perfetto_packets.hpp"

namespace torolux {

inline constexpr std::uint64_t kLeastTraceBytes = 64U << 10U;

/// What goes into a trace.
struct TraceChoice {
  Cycles from = 0, to = ~Cycles{0};        ///< window of virtual time [cycles], `to` not in it
  std::vector<unsigned> pes = {};          ///< ascending; empty: all
  std::uint64_t most_bytes = 256U << 20U;  ///< kLeastTraceBytes and up
  std::uint32_t grain_shift = 16;          ///< of MachineWatcher
  std::uint64_t arrows = 256;              ///< one packet of so many has one; 0: none
};

/// Of each track, slices and samples stand in order of time, and no slice overlaps another. A slice is written once it
/// has ended, so none is ever open.
class PerfettoTrace final : public MachineWatcher {
 public:
  /// take: gets the bytes.
  PerfettoTrace(TraceChoice choice, PerfettoPackets::Take take);

  std::uint32_t grain_shift() const override { return choice_.grain_shift; }
  void begin(const WatchedMachine& machine) override;
  void pe_state(unsigned pe, Cycles begin, PeState state) override;
  void bus_state(Cycles begin, std::size_t state) override;
  void host_state(Cycles begin, bool busy) override;
  void frame_buffer_state(Cycles begin, bool busy) override;
  void stage(Cycles begin, std::string_view name) override;
  void gauge(Cycles begin, HostGauge gauge, double value) override;
  void counters(Cycles time, unsigned pe, const PeCounters& counters) override;
  void counters(Cycles time, const MachineCounters& counters) override;
  void sent(Cycles time, const PacketName& packet) override;
  void received(Cycles time, const PacketName& packet) override;
  void end(Cycles time) override;

  /// All that is open ends, where the run has not come to its end: at the last time that was told. Once.
  void finish();

  std::uint64_t bytes() const { return packets_.bytes(); }
  /// From this cycle on the trace was full, and what came was left out; absent: all is in it.
  std::optional<Cycles> full_at() const { return full_at_; }

 private:
  struct Lane {
    NameId name = 0;  // of the slice that is open; 0: none is
    Cycles since = 0;
  };
  struct CounterLane {
    std::uint64_t value = 0;
    bool known = false;
  };
  static constexpr std::size_t kPeCounters = 5, kMachineCounters = 6;

  bool shows(unsigned pe) const { return pe < shown_.size() && shown_[pe]; }
  bool in_window(Cycles time) const { return time >= choice_.from && time < choice_.to; }
  std::uint64_t nanoseconds(Cycles time) const;
  bool room(Cycles time, std::uint64_t bytes = 0);
  void change(Lane& lane, TrackId track, Cycles time, NameId name);
  NameId name_of_state(PeState state);
  NameId name_of_part(Cycles begin, std::string_view name);
  void sample(CounterLane& lane, TrackId track, Cycles time, std::uint64_t value);
  void make_machine_tracks();
  void make_pe_tracks(unsigned pe);
  void tell_settings(const WatchedMachine& machine);
  bool followed(const PacketName& packet) const;
  void end_arrow(Cycles time, unsigned pe, std::uint64_t number, std::string_view name, const PacketName& packet);

  TraceChoice choice_;
  PerfettoPackets packets_;
  unsigned columns_ = 0;
  PhaseNames phases_;
  std::uint64_t hertz_ = 1;
  std::vector<bool> shown_;
  Cycles last_ = 0;
  std::optional<Cycles> full_at_;
  bool finished_ = false;
  std::vector<Lane> pes_;
  std::vector<std::array<CounterLane, kPeCounters>> pe_counters_;
  std::array<CounterLane, kMachineCounters> machine_counters_{};
  Lane stage_, rounds_, bus_, host_, frame_buffer_;
  std::uint64_t round_ = 0;  // rounds begun
  std::array<NameId, kPeStates> state_names_{};
  std::map<std::uint64_t, PacketName> arrows_;  // begun, not ended
};

}  // namespace torolux
