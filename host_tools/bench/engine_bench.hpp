// SPDX-License-Identifier: MIT
// How much of QEMU's speed is left in the machine: a render, and the same PEs' instructions on QEMU alone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "host_tools/render/render.hpp"

namespace torolux {

/// Instructions executed, and what they took.
struct EngineSpeed {
  std::uint64_t instructions = 0;
  double wall_seconds = 0;  ///< from the start of the first process to the end of the last
  double cpu_seconds = 0;   ///< of the QEMU processes, all together

  double instructions_per_second() const {
    return wall_seconds > 0 ? static_cast<double>(instructions) / wall_seconds : 0;
  }
  double instructions_per_cpu_second() const {
    return cpu_seconds > 0 ? static_cast<double>(instructions) / cpu_seconds : 0;
  }
};

struct EngineBenchResult {
  EngineSpeed machine;           ///< the PEs in a render
  EngineSpeed bare;              ///< QEMU alone: no network, no emulator, no waiting
  double scheduler_seconds = 0;  ///< host CPU time of the emulator itself in the render
  bool whole = true;             ///< false: bare has only the beginning of the run, as the log was full

  /// Speed in the machine / speed of QEMU alone, both by wall time on the same cores.
  double ratio() const { return machine.instructions_per_second() / bare.instructions_per_second(); }
  /// The same, both by the host CPU time of the PEs' processes.
  double cpu_ratio() const { return machine.instructions_per_cpu_second() / bare.instructions_per_cpu_second(); }
  /// Of all host CPU time in the render.
  double emulator_share() const { return scheduler_seconds / (scheduler_seconds + machine.cpu_seconds); }
};

/// What is to be rendered; the engine is always qemu.
struct EngineBenchJob {
  const Scene& scene;
  Camera camera;
  Quality quality;
  MachineChoice machine;
  std::filesystem::path pe_image;
  unsigned repetitions = 1;  ///< of the two measurements, by turns: other programs disturb the one or the other
};

/// Renders once to record what the NIU gave each PE; then, by turns, renders and starts all PEs again to replay that to
/// them. Of each the fastest counts. Throws as render does; step is told what comes next, progress as by render.
EngineBenchResult bench_engine(const EngineBenchJob& job, const std::function<void(const char*)>& step,
                               const std::function<bool(const RenderProgress&)>& progress);

}  // namespace torolux
