// SPDX-License-Identifier: MIT
// A whole Torolux: PEs on an engine, torus, system bus, host, frame buffer controller, in virtual time.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "emulator/engines/debugging.hpp"
#include "emulator/engines/engine.hpp"
#include "emulator/engines/image.hpp"
#include "emulator/host/host_program.hpp"
#include "emulator/machine/description.hpp"
#include "emulator/torus/figures.hpp"
#include "firmware/protocol/hints.hpp"

namespace torolux {

struct MachineSetup {
  MachineDescription description;
  unsigned columns = 4;
  unsigned rows = 4;
  std::uint32_t local_memory_bytes = protocol::kDefaultLocalMemory;
  std::string engine = kDefaultEngine;
  Debugging debugging;
  unsigned threads = 0;  ///< 0: all cores
  std::uint32_t frame_width = 0;
  std::uint32_t frame_height = 0;
  std::uint32_t frame_layers = 0;  ///< planes of the frame buffer besides the colours, as bits (protocol::plane_bit)
};

struct PeFigures {
  Cycles busy_cycles = 0;  ///< executing instructions
  Cycles idle_cycles = 0;  ///< asleep in receive, or waiting to send, until the end of the run
  bool halted = false;     ///< its program has ended
  std::uint64_t instructions = 0;
  std::uint64_t packets_sent = 0;       ///< to the torus
  std::uint64_t packets_delivered = 0;  ///< from the torus, diverted ones too
  std::uint64_t records_diverted = 0;
  std::uint32_t record_slots_high_water = 0;
  std::array<Cycles, protocol::kPhases> phase_cycles{};  ///< innermost phase
};

struct MachineFigures {
  Cycles now = 0;                ///< virtual time of the last event
  std::uint64_t trace_hash = 0;  ///< of the sequence of all events: equal runs have equal ones
  std::vector<PeFigures> pes;
  std::vector<RouterFigures> routers;  ///< of each PE
  PacketFigures packets;               ///< that have left the torus
  std::uint64_t hops = 0;              ///< links crossed by all delivered packets
  std::uint64_t link_retries = 0;
  Cycles bus_busy_cycles = 0;
  std::uint64_t bus_messages = 0;
  Cycles frame_buffer_busy_cycles = 0;
  std::uint64_t pixels_added = 0;
  double scheduler_seconds = 0;  ///< host CPU time that the emulator itself used
  double engine_seconds = 0;     ///< host CPU time of the engine (all its processes or threads)

  std::uint64_t instructions() const;  ///< of all PEs
};

class Machine {
 public:
  /// Loads the image into every PE. Throws InputError, MachineFailure.
  Machine(const MachineSetup& setup, const Image& image);
  ~Machine();

  /// Runs until the program has finished and the machine is empty. Once per machine.
  /// progress: called about ten times a second of wall time, from the calling thread; returning false ends the run.
  /// Throws MachineFailure: trap, dead or silent PE, deadlock (with what each actor waits for), fault of the program.
  void run(HostProgram& program, const std::function<bool(Cycles)>& progress = {});

  const FrameBuffer& frame_buffer() const;
  /// Exact at a moment when nothing is in flight (between stages, at the end): a host program may ask in on_message.
  MachineFigures figures() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace torolux
