// SPDX-License-Identifier: MIT
// Renders by turns on each number of threads that is to be measured; the turns of one thread predict the others.
#include "host_tools/bench/cores_bench.hpp"

#include <algorithm>

#include "emulator/engines/engine/turn_log.hpp"
#include "host_tools/bench/predicted_time.hpp"

namespace torolux {

std::vector<CoresTime> bench_cores(const RenderBenchJob& job, std::span<const unsigned> cores, unsigned measured,
                                   double exchange, const std::function<bool(const RenderProgress&)>& progress) {
  std::vector<CoresTime> times(cores.size());
  TurnLog least;
  for (unsigned repetition = 0; repetition < job.repetitions; ++repetition) {
    for (std::size_t i = 0; i < cores.size(); ++i) {
      times[i].cores = cores[i];
      if (cores[i] > measured) continue;
      TurnLog turns;
      MachineChoice machine = job.machine;
      machine.engine = "translated";
      machine.threads = cores[i];
      machine.turns = cores[i] == 1 ? &turns : nullptr;
      const double wall =
          render(job.scene, job.camera, job.quality, machine, {}, job.pe_image, progress).figures.wall_seconds;
      if (repetition == 0 || wall < times[i].measured) {
        times[i].measured = wall;
        if (cores[i] == 1) least = std::move(turns);
      }
    }
  }
  const double outside = times.front().measured - measured_seconds(least);
  for (CoresTime& time : times) {
    time.predicted = outside + predicted_seconds(least, time.cores);
    if (time.cores > 1) time.on_ranks = outside + predicted_on_ranks(least, time.cores, exchange);
  }
  return times;
}

}  // namespace torolux
