// SPDX-License-Identifier: MIT
// Packets per second through the torus's model, uniform traffic at half of what it bears.
#include <benchmark/benchmark.h>

#include <random>

#include "tests/unit/emulator/torus_driver.hpp"

namespace torolux::test {
namespace {

void uniform_traffic(benchmark::State& state) {
  const auto side = static_cast<unsigned>(state.range(0));
  constexpr unsigned kPackets = 2000;
  constexpr std::uint32_t kFlits = 4;
  MachineDescription::Torus parameters;
  // Ideal throughput of a k-ary torus is 8 / k flits per node and cycle, at most one (shared/notes/torus_theory.md).
  const double per_cycle = 0.5 * std::min(1.0, 8.0 / side) / kFlits * side * side;
  for (auto _ : state) {
    TorusDriver torus(side, side, parameters);
    std::minstd_rand random(1);
    for (unsigned i = 0; i < kPackets; ++i) {
      const auto when = static_cast<Cycles>(i / per_cycle);
      torus.send(static_cast<unsigned>(random() % (side * side)), static_cast<unsigned>(random() % (side * side)),
                 kFlits, when);
    }
    benchmark::DoNotOptimize(torus.run());
  }
  state.SetItemsProcessed(state.iterations() * kPackets);
}
BENCHMARK(uniform_traffic)->Name("torus/uniform")->Arg(4)->Arg(8)->Arg(16)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace torolux::test
