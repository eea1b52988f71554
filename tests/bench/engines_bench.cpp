// SPDX-License-Identifier: MIT
// Ray-triangle tests per second: on QEMU, translated, and compiled for this computer. Starting an engine is included.
#include <benchmark/benchmark.h>

#include "tests/images/triangles.hpp"
#include "tests/translated/runs.hpp"
#include "tests/unit/engines/engine_support.hpp"

namespace torolux::test {
namespace {

constexpr std::int64_t kTests = std::int64_t{kBenchRays} * 64;

void on_pe(benchmark::State& state, Way way) {
  const Image image = load_image(example_image("triangles"));
  run_to_halt(image, Way::translated);  // so that the cache has it
  for (auto _ : state) {
    const Outcome outcome = run_to_halt(image, way);
    if (!outcome.halted) state.SkipWithError(outcome.failure.c_str());
  }
  state.SetItemsProcessed(state.iterations() * kTests);
}
BENCHMARK_CAPTURE(on_pe, qemu, Way::qemu)->Name("triangles/qemu")->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(on_pe, translated, Way::translated)
    ->Name("triangles/translated")
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

void native(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(cross_triangles(kBenchRays));
  state.SetItemsProcessed(state.iterations() * kTests);
}
BENCHMARK(native)->Name("triangles/native")->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace torolux::test
