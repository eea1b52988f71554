// SPDX-License-Identifier: MIT
// A scene without light is put into the studio. All are rendered on one PE, as a picture is the same on any machine.
#include "tests/accuracy/runs.hpp"

#include <sys/resource.h>

#include <algorithm>

#include "host_tools/mesh/mesh.hpp"

namespace torolux::accuracy {
namespace {

Scene load(const std::filesystem::path& path) {
  Scene scene = load_scene(path, {});
  if (scene.sky || std::ranges::any_of(scene.materials, emits)) return scene;
  SceneOptions options;
  options.studio = true;
  return load_scene(path, options);
}

}  // namespace

SceneRun resolve_scene(const std::filesystem::path& path, const ReportChoice& choice) {
  SceneRun run{load(path), {}};
  run.resolved = resolve({}, run.scene);
  run.resolved.quality.width = std::max(1U, run.resolved.quality.width / choice.shrink);
  run.resolved.quality.height = std::max(1U, run.resolved.quality.height / choice.shrink);
  MachineChoice& machine = run.resolved.machine;
  machine.engine = choice.engine;
  machine.threads = choice.threads;
  // One PE and many records: no time in hand-overs. The picture is the same on any machine.
  machine.columns = machine.rows = 1;
  machine.description.records.credits_per_pe = 2048;
  return run;
}

std::vector<Setting> chosen_settings(const ReportChoice& choice) {
  std::vector<Setting> chosen;
  for (const Setting& setting : kSettings) {
    if (choice.settings.empty() || std::ranges::find(choice.settings, setting.name) != choice.settings.end()) {
      chosen.push_back(setting);
    }
  }
  return chosen;
}

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace torolux::accuracy
