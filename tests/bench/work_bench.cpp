// SPDX-License-Identifier: MIT
// The PEs' whole work in a small render, with a record of what their NIUs did instead of a machine: translated, and
// the same handlers compiled for this computer. Records once, on QEMU. Host CPU time of one PE after the other.
#include <benchmark/benchmark.h>

#include <map>
#include <string>

#include "host_tools/bench/replay.hpp"
#include "host_tools/render/render.hpp"
#include "host_tools/scene/load_scene.hpp"

namespace torolux::test {
namespace {

Recording record_scene(const std::string& name) {
  const std::filesystem::path pe_image = std::filesystem::path(TOROLUX_FIRMWARE_DIR) / "pe.elf";
  const Scene scene = load_scene(std::filesystem::path(TOROLUX_SOURCE_DIR) / "scenes" / name, {});
  Quality quality;
  quality.width = quality.height = 64;
  quality.max_shots = 60;
  MachineChoice machine;
  return record(load_image(pe_image), machine.description, std::size_t{machine.columns} * machine.rows,
                [&](const std::string& engine) {
                  machine.engine = engine;
                  const auto figures = render(scene, scene.camera.value(), quality, machine, {}, pe_image, {}).figures;
                  return RecordedFigures{figures.local_memory_bytes, figures.machine.instructions()};
                });
}

Recording& recording_of(const std::string& scene) {
  static std::map<std::string, Recording> recordings;
  const auto found = recordings.find(scene);
  return found != recordings.end() ? found->second : recordings.emplace(scene, record_scene(scene)).first->second;
}

void work(benchmark::State& state, const char* scene, EngineSpeed (*replay)(Recording&, unsigned)) {
  Recording& recording = recording_of(scene);
  for (auto _ : state) state.SetIterationTime(replay(recording, 1).cpu_seconds);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(recording.instructions));
}
BENCHMARK_CAPTURE(work, cornell_translated, "cornell_box", replay_on_translated)->UseManualTime();
BENCHMARK_CAPTURE(work, cornell_native, "cornell_box", replay_natively)->UseManualTime();
BENCHMARK_CAPTURE(work, interior_translated, "interior", replay_on_translated)->UseManualTime();
BENCHMARK_CAPTURE(work, interior_native, "interior", replay_natively)->UseManualTime();

}  // namespace
}  // namespace torolux::test
