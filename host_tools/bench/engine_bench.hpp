// SPDX-License-Identifier: MIT
// How fast the engines are, and how much of that is left in the machine: a render on each, and the same PEs'
// instructions on each alone; and so for the innermost loop, which needs no machine.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "host_tools/bench/replay.hpp"
#include "host_tools/render/render.hpp"

namespace torolux {

/// The same instructions on each engine, with nothing around them.
struct BareSpeeds {
  EngineSpeed translated, qemu;
  std::optional<EngineSpeed> native;  ///< compiled for this computer, where the program has that code

  /// Host CPU time on QEMU / translated.
  double qemu_ratio() const { return qemu.cpu_seconds / translated.cpu_seconds; }
  /// Host CPU time translated / native.
  std::optional<double> native_ratio() const {
    return native ? std::optional(translated.cpu_seconds / native->cpu_seconds) : std::nullopt;
  }
};

/// One engine in a render.
struct MachineSpeed {
  EngineSpeed pes;
  double scheduler_seconds = 0;  ///< host CPU time of the emulator itself

  /// Of all host CPU time.
  double emulator_share() const { return scheduler_seconds / (scheduler_seconds + pes.cpu_seconds); }
};

struct RenderBenchResult {
  MachineSpeed translated, qemu;
  BareSpeeds bare;
  bool whole = true;  ///< false: bare has only the beginning of the run, as the log was full
};

/// What is to be rendered; machine.engine does not count.
struct RenderBenchJob {
  const Scene& scene;
  Camera camera;
  Quality quality;
  MachineChoice machine;
  std::filesystem::path pe_image;
  unsigned repetitions = 1;  ///< of the measurements, by turns: other programs disturb the one or the other
};

/// Is told what comes next.
using BenchStep = std::function<void(const char*)>;

/// Renders once to record what the NIU gave each PE; then, by turns, renders on each engine, and starts all PEs again
/// to replay that to them. Of each the fastest counts. Throws as render does; progress as by render.
RenderBenchResult bench_render(const RenderBenchJob& job, const BenchStep& step,
                               const std::function<bool(const RenderProgress&)>& progress);

/// An image that needs no other PE, on one PE. Throws as run_image does; progress as by Machine::run.
BareSpeeds bench_image(const std::filesystem::path& image, unsigned repetitions, const BenchStep& step,
                       const std::function<bool(Cycles)>& progress);

}  // namespace torolux
