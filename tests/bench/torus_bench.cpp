// SPDX-License-Identifier: MIT
// Links crossed by packets per second through the torus's model: uniform traffic near half of what it bears.
#include <benchmark/benchmark.h>

#include "emulator/traffic/traffic.hpp"

namespace torolux {
namespace {

void uniform_traffic(benchmark::State& state) {
  TrafficSetup setup;
  setup.columns = setup.rows = static_cast<unsigned>(state.range(0));
  setup.packet_flits = 4;
  setup.rate = static_cast<double>(state.range(1)) * 1e-2;
  setup.warm_up = 1000;
  setup.cycles = 10000;
  std::uint64_t hops = 0;
  for (auto _ : state) hops += run_traffic(setup).packet_hops;
  state.counters["packet_hops_per_second"] = benchmark::Counter(static_cast<double>(hops), benchmark::Counter::kIsRate);
}
// k, and a hundred times the rate: saturation is at 0.76, 0.52 and 0.28 flits per node and cycle.
BENCHMARK(uniform_traffic)
    ->Name("torus/uniform")
    ->Args({4, 38})
    ->Args({8, 26})
    ->Args({16, 14})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace torolux
