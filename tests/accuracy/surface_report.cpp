// SPDX-License-Identifier: MIT
// See surface_report.hpp.
#include "tests/accuracy/surface_report.hpp"

#include <cmath>
#include <numbers>

#include "firmware/protocol/triangle_grid.hpp"
#include "tests/accuracy/table.hpp"
#include "tests/references/path_tracer.hpp"
#include "tests/support/solve_scene.hpp"

namespace torolux::accuracy {
namespace {

struct Light {
  double flux = 0;      ///< [W], all channels
  double variance = 0;  ///< of flux
};

/// By material, on the sides that the mesh has.
std::vector<Light> traced_light(const SceneRun& run, const Mesh& mesh, std::uint32_t paths) {
  const references::World world(run.scene, run.settled.quality.two_sided_lights);
  double area = 0;
  for (const references::Triangle& triangle : world.triangles()) area += triangle.area;
  std::vector<Light> light(run.scene.materials.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const references::Triangle& triangle = world.triangles()[t];
    const auto count = static_cast<std::uint32_t>(std::ceil(triangle.area / area * paths)) + 8;
    for (const bool front : {true, false}) {
      if ((mesh.triangles[t].sides & (front ? protocol::kFrontPresent : protocol::kBackPresent)) == 0) continue;
      references::Samples samples(front ? 1 : 2, t);
      double sum = 0;
      double squares = 0;
      for (std::uint32_t i = 0; i < count; ++i) {
        samples.begin(i);
        const auto [u, v] = samples.pair(0);
        const double root = std::sqrt(u);
        const double value = references::incident_over_pi(world, world.at(t, root * (1 - v), root * v, front),
                                                          references::LightFinding::both, samples)
                                 .sum();
        sum += value;
        squares += value * value;
      }
      const double scale = std::numbers::pi * triangle.area / count;
      light[triangle.material].flux += scale * sum;
      light[triangle.material].variance += scale * scale * (squares - sum * sum / count);
    }
  }
  return light;
}

std::vector<double> solved_light(const test::SolvedScene& solved) {
  std::vector<double> light(solved.scene.materials.size(), 0);
  for (const MeshPatch& patch : solved.mesh.patches) {
    for (const std::uint32_t first : patch.first_element) {
      if (first == protocol::kNoSide) continue;
      for (std::uint32_t e = 0; e < patch.elements; ++e) {
        for (const double watts : solved.incident_flux(first + e)) light[patch.material] += watts;
      }
    }
  }
  return light;
}

void add_scene(Table& table, const std::filesystem::path& path, const ReportChoice& choice) {
  const SceneRun run = settle_scene(path, choice);
  std::vector<Light> should;
  for (const Setting& setting : chosen_settings(choice)) {
    test::RenderCase render_case;
    render_case.quality = quality_at(setting, run.scene);
    render_case.quality.width = render_case.quality.height = 4;
    render_case.machine = run.settled.machine;
    render_case.camera = run.settled.camera;
    const test::SolvedScene solved = test::solve_scene(run.scene, render_case);
    if (solved.mesh.triangles.size() != run.scene.triangles.size()) return;
    if (should.empty()) should = traced_light(run, solved.mesh, choice.surface_paths);
    const std::vector<double> is = solved_light(solved);
    Light all_should;
    double all_is = 0;
    const auto add = [&](const std::string& name, double flux, const Light& light) {
      table.add({run.scene.name, std::string(setting.name), name, text_of("%.5g", flux), text_of("%.5g", light.flux),
                 text_of("%+.2f", 100 * (flux / light.flux - 1)),
                 text_of("%.2f", 100 * std::sqrt(light.variance) / light.flux)});
    };
    for (std::size_t m = 0; m < should.size(); ++m) {
      if (!(should[m].flux > 0)) continue;
      add(run.scene.materials[m].name, is[m], should[m]);
      all_is += is[m];
      all_should.flux += should[m].flux;
      all_should.variance += should[m].variance;
    }
    add("(all)", all_is, all_should);
  }
}

}  // namespace

void report_surfaces(const ReportChoice& choice) {
  std::filesystem::create_directories(choice.output);
  Table table({"scene", "setting", "material", "incident flux [W]", "path traced [W]", "difference [%]",
               "noise of the reference [%]"});
  for (const auto& scene : choice.scenes) add_scene(table, scene, choice);
  table.write(choice.output / "surfaces");
}

}  // namespace torolux::accuracy
