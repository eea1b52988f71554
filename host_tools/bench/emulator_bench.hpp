// SPDX-License-Identifier: MIT
// What the emulator itself costs, beside the PEs: renders on the translated engine, with as many PEs as are asked for.
#pragma once

#include <cstdint>
#include <functional>

#include "host_tools/bench/engine_bench.hpp"

namespace torolux {

struct EmulatorCost {
  double scheduler_seconds = 0;  ///< host CPU time of the one thread that handles all events, without PEs that it ran
  double program_seconds = 0;    ///< of it, of the host's program
  double pe_seconds = 0;         ///< host CPU time of the PEs
  double wall_seconds = 0;
  std::uint64_t packets = 0;  ///< on the torus
  std::uint64_t hops = 0;     ///< links that they crossed

  /// Of all host CPU time.
  double share() const { return scheduler_seconds / (scheduler_seconds + pe_seconds); }
  double program_share() const { return program_seconds / (scheduler_seconds + pe_seconds); }
};

/// job.repetitions times; that with the least CPU time of the emulator counts. Throws as render does; progress as by
/// render.
EmulatorCost bench_emulator(const RenderBenchJob& job, const std::function<bool(const RenderProgress&)>& progress);

}  // namespace torolux
