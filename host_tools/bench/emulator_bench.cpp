// SPDX-License-Identifier: MIT
// Renders, and keeps the figures of the cheapest.
#include "host_tools/bench/emulator_bench.hpp"

namespace torolux {

EmulatorCost bench_emulator(const RenderBenchJob& job, const std::function<bool(const RenderProgress&)>& progress) {
  EmulatorCost least;
  MachineChoice machine = job.machine;
  machine.engine = "translated";
  for (unsigned i = 0; i < job.repetitions; ++i) {
    const RenderFigures figures =
        render(job.scene, job.camera, job.quality, machine, {}, job.pe_image, progress).figures;
    const MachineFigures& all = figures.machine;
    const EmulatorCost cost{all.scheduler_seconds, all.program_seconds, all.engine_seconds,
                            figures.wall_seconds,  all.packets.packets, all.packets.hops};
    if (i == 0 || cost.scheduler_seconds < least.scheduler_seconds) least = cost;
  }
  return least;
}

}  // namespace torolux
