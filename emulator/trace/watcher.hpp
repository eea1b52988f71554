// SPDX-License-Identifier: MIT
// Who watches a machine: states, counters and packets enter, in the same order and with the same times in every run.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "emulator/bus/bus_figures.hpp"
#include "emulator/description/description.hpp"
#include "emulator/host/host_program.hpp"
#include "emulator/niu/pe_states.hpp"
#include "emulator/phase_names.hpp"

namespace torolux {

/// What the bus carries is a BusKind; or this.
inline constexpr std::size_t kBusIdle = kBusKinds;
inline constexpr std::size_t kBusStates = kBusKinds + 1;

struct WatchedMachine {
  const MachineDescription& description;
  unsigned columns, rows;
  const PhaseNames& phases;
};

/// Of a PE, at a moment. The limits are the machine's: places of the queues, slots, buffers.
struct PeCounters {
  std::uint32_t torus_queue;      ///< packets in its outgoing queue
  std::uint32_t bus_queue;        ///< messages in its outgoing queue
  std::uint32_t record_slots;     ///< in use
  std::uint32_t receive_buffers;  ///< in use
  std::uint32_t link_use;         ///< [%] of the time since the last sample, of its busiest outgoing link
  bool operator==(const PeCounters&) const = default;
};

struct MachineCounters {
  std::uint32_t torus_packets;                        ///< in outgoing queues, or on their way
  std::uint32_t frame_buffer_messages;                ///< that wait or are being added
  std::uint32_t host_messages;                        ///< not yet read
  std::uint32_t bus_use, host_use, frame_buffer_use;  ///< [%] of the time since the last sample
  bool operator==(const MachineCounters&) const = default;
};

/// A packet of records from a PE to another.
struct PacketName {
  std::uint64_t number;  ///< differs from that of every other packet; the same in every run
  std::uint16_t source, destination;
  std::uint16_t records;
};

/// All times are virtual [cycles]. Those of one kind and, where it has a PE, one PE never fall; those of several may.
class MachineWatcher {
 public:
  virtual ~MachineWatcher() = default;
  /// Grains of 2^shift cycles, 0..40: of each, one state is told (StateTally) and one sample of the counters.
  virtual std::uint32_t grain_shift() const = 0;
  virtual void begin(const WatchedMachine& machine) = 0;

  // ---- States, each until the next one of the same ----
  virtual void pe_state(unsigned pe, Cycles begin, PeState state) = 0;
  virtual void bus_state(Cycles begin, std::size_t state) = 0;  ///< BusKind or kBusIdle
  virtual void host_state(Cycles begin, bool busy) = 0;
  virtual void frame_buffer_state(Cycles begin, bool busy) = 0;
  virtual void stage(Cycles begin, std::string_view name) = 0;
  virtual void gauge(Cycles begin, HostGauge gauge, double value) = 0;

  // ---- Samples ----
  virtual void counters(Cycles time, unsigned pe, const PeCounters& counters) = 0;
  virtual void counters(Cycles time, const MachineCounters& counters) = 0;

  // ---- Packets ----
  /// Into its outgoing queue.
  virtual void sent(Cycles time, const PacketName& packet) = 0;
  /// Into the record slots of its PE, over the bus where it was diverted.
  virtual void received(Cycles time, const PacketName& packet) = 0;

  /// The run has come to its end; not called where it failed.
  virtual void end(Cycles time) = 0;
};

}  // namespace torolux
