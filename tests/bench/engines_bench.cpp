// SPDX-License-Identifier: MIT
// Ray-triangle tests per second: on QEMU, translated, and compiled for this computer. What is measured is the
// difference of two lengths of the same work, so the start of an engine is no part of it.
#include <benchmark/benchmark.h>

#include <chrono>

#include "firmware/protocol/niu_window.hpp"
#include "tests/images/triangles.hpp"
#include "tests/translated/runs.hpp"
#include "tests/unit/emulator/engines/engine_support.hpp"

namespace torolux::test {
namespace {

constexpr std::int64_t kTests = std::int64_t{kBenchRays} * 64;

template <class Work>
double seconds_of(Work work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void run_rays(benchmark::State& state, const Image& image, Way way, std::uint32_t rays) {
  const auto say_how_many = [&](std::span<std::byte> local_memory) {
    const std::size_t window = image.niu_window - protocol::kLocalMemoryBase;
    auto& head = *reinterpret_cast<protocol::NiuWindow*>(local_memory.data() + window);
    head.fault.detail[1] = rays;
  };
  const Outcome outcome = run_to_halt(image, way, say_how_many);
  if (!outcome.halted) state.SkipWithError(outcome.failure.c_str());
}

void on_pe(benchmark::State& state, Way way) {
  const Image image = load_image(example_image("triangles"));
  run_rays(state, image, Way::translated, 1);  // so that the cache has it
  for (auto _ : state) {
    const double start = seconds_of([&] { run_rays(state, image, way, 1); });
    state.SetIterationTime(seconds_of([&] { run_rays(state, image, way, kBenchRays + 1); }) - start);
  }
  state.SetItemsProcessed(state.iterations() * kTests);
}
BENCHMARK_CAPTURE(on_pe, qemu, Way::qemu)->Name("triangles/qemu")->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(on_pe, translated, Way::translated)
    ->Name("triangles/translated")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

void native(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(cross_triangles(kBenchRays));
  state.SetItemsProcessed(state.iterations() * kTests);
}
BENCHMARK(native)->Name("triangles/native")->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace torolux::test
