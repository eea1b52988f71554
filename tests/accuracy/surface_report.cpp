// SPDX-License-Identifier: MIT
// Each scene is solved at each setting; a row of the table surfaces leaves for each material, and one for all: incident
// flux in the solution and by the path tracer [W], and the noise of that.
#include "tests/accuracy/surface_report.hpp"

#include "tests/accuracy/table.hpp"
#include "tests/support/surface_light.hpp"

namespace torolux::accuracy {
namespace {

void add_scene(Table& table, const std::filesystem::path& path, const ReportChoice& choice) {
  const SceneRun run = resolve_scene(path, choice);
  std::vector<std::uint32_t> material;
  for (const SceneTriangle& triangle : run.scene.triangles) material.push_back(triangle.material);
  std::vector<test::GroupLight> should;
  for (const Setting& setting : chosen_settings(choice)) {
    test::RenderCase render_case;
    render_case.quality = quality_at(setting, run.scene);
    render_case.quality.width = render_case.quality.height = 4;
    render_case.machine = run.resolved.machine;
    render_case.camera = run.resolved.camera;
    const test::SolvedScene solved = test::solve_scene(run.scene, render_case);
    if (solved.mesh.triangles.size() != run.scene.triangles.size()) return;
    if (should.empty()) {
      const references::World world(run.scene, run.resolved.quality.two_sided_lights);
      should =
          test::traced_light(world, solved.mesh, material, test::paths_by_area(world, material, choice.surface_paths));
    }
    const std::vector<test::GroupLight> is = test::solved_light(solved, material);
    test::GroupLight all_should;
    double all_is = 0;
    const auto add = [&](const std::string& name, double flux, const test::GroupLight& light) {
      table.add({run.scene.name, std::string(setting.name), name, text_of("%.5g", flux), text_of("%.5g", light.all()),
                 text_of("%+.2f", 100 * (flux / light.all() - 1)), text_of("%.2f", 100 * light.relative_noise())});
    };
    for (std::size_t m = 0; m < should.size(); ++m) {
      if (!(should[m].all() > 0)) continue;
      add(run.scene.materials[m].name, is[m].all(), should[m]);
      all_is += is[m].all();
      for (std::size_t c = 0; c < 3; ++c) {
        all_should.flux[c] += should[m].flux[c];
        all_should.variance[c] += should[m].variance[c];
      }
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
