// SPDX-License-Identifier: MIT
// How long somebody who walks through the Cornell box waits: 64 PEs, a picture of 256 x 256. `first_run` is the render
// that comes before, in the same process [s].
#include <benchmark/benchmark.h>

#include <memory>

#include "host_tools/display/walk.hpp"
#include "host_tools/render/session.hpp"
#include "host_tools/scene/load_scene.hpp"

namespace torolux {
namespace {

constexpr std::uint32_t kEdge = 256;

/// Solved once; a machine that stays.
struct Solved {
  Scene scene = load_scene(std::filesystem::path(TOROLUX_SOURCE_DIR) / "scenes/cornell_box", {});
  Camera camera = scene.camera.value();
  Quality quality = [] {
    Quality normal;
    normal.width = normal.height = kEdge;
    return normal;
  }();
  MachineChoice machine = [] {
    MachineChoice choice;
    choice.columns = choice.rows = 8;
    return choice;
  }();
  RenderFiles files;
  std::function<bool(const RenderProgress&)> nobody;
  RenderSession session{scene, camera, quality, machine, files, TOROLUX_FIRMWARE_DIR "/pe.elf", nobody};
  double first_run = session.run(Machine::Then::stay).figures.wall_seconds;

  static Solved& once() {
    static const std::unique_ptr<Solved> solved = std::make_unique<Solved>();
    return *solved;
  }
};

/// passes: of all that a walk makes of a view; coarse: its first, small one alone.
void walk(benchmark::State& state, bool coarse) {
  Solved& solved = Solved::once();
  Camera camera = solved.camera;
  const auto wanted = [] { return true; };
  for (auto _ : state) {
    camera.eye[0] += 10;  // elsewhere each time
    const auto passes = refining_passes(solved.quality.samples);
    solved.session.view({camera, kEdge / Walk::kCoarse, kEdge / Walk::kCoarse, passes.front()}, wanted);
    benchmark::DoNotOptimize(solved.session.picture(1));
    if (coarse) continue;
    for (const SamplePass& pass : passes) {
      solved.session.view({camera, kEdge, kEdge, pass, pass.first > 0}, wanted);
      benchmark::DoNotOptimize(solved.session.picture(pass.first + pass.count));
    }
  }
  state.counters["first_run"] = solved.first_run;
}

BENCHMARK_CAPTURE(walk, coarse, true)->UseRealTime()->Unit(benchmark::kMillisecond)->Iterations(20);
BENCHMARK_CAPTURE(walk, refined, false)->UseRealTime()->Unit(benchmark::kMillisecond)->Iterations(5);

}  // namespace
}  // namespace torolux
