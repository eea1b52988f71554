// SPDX-License-Identifier: MIT
// Events per second through the queue at a constant number of waiting ones (the hold model).
#include <benchmark/benchmark.h>

#include <random>

#include "emulator/time/event_queue.hpp"

namespace torolux {
namespace {

void hold(benchmark::State& state) {
  constexpr std::uint32_t kSources = 64;
  EventQueue queue(kSources);
  std::minstd_rand random(1);
  const auto push = [&](Cycles now) {
    queue.push(now + 1 + random() % 1000, static_cast<std::uint32_t>(random() % kSources), EventKind::arrive, 0, 0, 0);
  };
  for (std::int64_t i = 0; i < state.range(0); ++i) push(0);
  for (auto _ : state) {
    const Event event = queue.pop();
    push(event.time);
    benchmark::DoNotOptimize(event);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(hold)->Name("event_queue/hold")->Arg(16)->Arg(256)->Arg(4096);

}  // namespace
}  // namespace torolux
