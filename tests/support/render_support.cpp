// SPDX-License-Identifier: MIT
// For tests that render: a small scene and settings in, picture and figures out, on an engine by name.
#include "tests/support/render_support.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

namespace torolux::test {

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(source_dir() / "scenes")) {
    if (std::filesystem::exists(entry.path() / "scene.toml")) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

RenderCase native_case(const std::filesystem::path& scene) {
  RenderCase result;
  result.scene = scene;
  result.quality.width = 32;
  result.quality.height = 32;
  result.quality.samples = 1;
  result.quality.hemicube = 8;
  result.quality.shot_points = 2;
  result.quality.unshot = 0.01;
  result.quality.shadow_rays = false;         // the radiosity stage is what most tests are about
  result.quality.emission_records = 200'000;  // enough for means; tests of what is finer choose their own
  result.machine.engine = "native";
  // One PE and many credits: least time in hand-overs. Tests of the machine itself choose their own.
  result.machine.columns = result.machine.rows = 1;
  result.machine.description.records.credits_per_pe = 2048;
  return result;
}

RenderResult run_case(const RenderCase& render_case) {
  const Scene scene = load_scene(render_case.scene, {});
  const Camera camera = render_case.camera ? *render_case.camera : scene.camera.value();
  return render(scene, camera, render_case.quality, render_case.machine, render_case.files, pe_image(), {});
}

std::vector<std::byte> bytes_of(const Picture& picture) {
  std::vector<std::byte> bytes(picture.pixels.size() * sizeof(picture.pixels.front()));
  std::memcpy(bytes.data(), picture.pixels.data(), bytes.size());
  return bytes;
}

std::string exact_figures(const RenderFigures& figures) {
  std::ostringstream text;
  text << "cycles " << figures.load_cycles << ' ' << figures.radiosity_cycles << ' ' << figures.ray_tracing_cycles
       << "\nshots " << figures.shots << " records " << figures.radiosity_records << " rays " << figures.rays
       << "\ncredits " << figures.credits_home << '/' << figures.credits_total << " hops "
       << figures.machine.packets.hops << " bus " << figures.machine.bus.busy_cycles() << ' '
       << figures.machine.bus.transfers << " fbc " << figures.machine.frame_buffer_busy_cycles << ' '
       << figures.machine.pixels_added << " trace " << figures.machine.trace_hash << '\n';
  for (const PeFigures& pe : figures.machine.pes) {
    text << pe.busy_cycles << ' ' << pe.idle_cycles() << ' ' << pe.instructions << ' ' << pe.packets_sent << ' '
         << pe.packets_delivered << ' ' << pe.records_diverted << ' ' << pe.record_slots_high_water;
    for (const Cycles cycles : pe.phase_cycles) text << ' ' << cycles;
    text << '\n';
  }
  return text.str();
}

double energy_error(const EnergyBalance& energy) {
  double worst = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double rest = energy.absorbed[c] + energy.absorbed_specular[c] + energy.unshot[c] + energy.escaped[c] +
                        energy.cut_off[c] + energy.back_side[c];
    if (energy.emitted[c] > 0) worst = std::fmax(worst, std::fabs(energy.emitted[c] - rest) / energy.emitted[c]);
  }
  return worst;
}

}  // namespace torolux::test
