// SPDX-License-Identifier: MIT
// How fast the engines are, and how much of that is left in the machine: a render on each, and the same PEs'
// instructions on each alone.
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
  double cpu_seconds = 0;   ///< of the processes or threads that ran them, all together

  double instructions_per_second() const {
    return wall_seconds > 0 ? static_cast<double>(instructions) / wall_seconds : 0;
  }
  double instructions_per_cpu_second() const {
    return cpu_seconds > 0 ? static_cast<double>(instructions) / cpu_seconds : 0;
  }
};

/// One engine: the PEs in a render, and the same PEs alone.
struct EngineResult {
  EngineSpeed machine;
  EngineSpeed bare;              ///< no network, no emulator, no waiting
  double scheduler_seconds = 0;  ///< host CPU time of the emulator itself in the render

  /// Speed in the machine / speed alone, both by wall time on the same cores.
  double ratio() const { return machine.instructions_per_second() / bare.instructions_per_second(); }
  /// The same, both by the host CPU time of the PEs' processes or threads.
  double cpu_ratio() const { return machine.instructions_per_cpu_second() / bare.instructions_per_cpu_second(); }
  /// Of all host CPU time in the render.
  double emulator_share() const { return scheduler_seconds / (scheduler_seconds + machine.cpu_seconds); }
};

struct EngineBenchResult {
  EngineResult translated, qemu;
  bool whole = true;  ///< false: bare has only the beginning of the run, as the log was full
};

/// What is to be rendered; machine.engine does not count.
struct EngineBenchJob {
  const Scene& scene;
  Camera camera;
  Quality quality;
  MachineChoice machine;
  std::filesystem::path pe_image;
  unsigned repetitions = 1;  ///< of the measurements, by turns: other programs disturb the one or the other
};

/// Renders once to record what the NIU gave each PE; then, by turns, renders on each engine, and starts all PEs again
/// to replay that to them. Of each the fastest counts. Throws as render does; step is told what comes next, progress as
/// by render.
EngineBenchResult bench_engine(const EngineBenchJob& job, const std::function<void(const char*)>& step,
                               const std::function<bool(const RenderProgress&)>& progress);

}  // namespace torolux
