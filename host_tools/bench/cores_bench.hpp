// SPDX-License-Identifier: MIT
// What more cores bring: a render on one thread, from which its time on more is predicted, and renders on as many as
// this computer has.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "host_tools/bench/engine_bench.hpp"

namespace torolux {

/// One number of cores. Wall time of both stages, without loading the scene [s].
struct CoresTime {
  unsigned cores = 1;
  double predicted = 0;  ///< predicted_time.hpp; of one: measured
  double on_ranks = 0;   ///< likewise, of so many ranks with one thread each; 0: of one
  double measured = 0;   ///< 0: it was not
};

/// One entry for each of `cores` (>= 1, the first 1), in their order; those of up to `measured` are measured, too.
/// exchange: time that a message between ranks takes [s]. job.repetitions times, the fastest counts. Throws as render
/// does; progress as by render.
std::vector<CoresTime> bench_cores(const RenderBenchJob& job, std::span<const unsigned> cores, unsigned measured,
                                   double exchange, const std::function<bool(const RenderProgress&)>& progress);

}  // namespace torolux
