// SPDX-License-Identifier: MIT
// A whole render saves its radiosities to a temporary file; they are read back, and the mesh is made again from the
// file's splits.
#include "tests/support/solve_scene.hpp"

#include "host_tools/setup/setup.hpp"
#include "host_tools/solution/radiosity_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {

std::array<double, 3> SolvedScene::incident_flux(std::uint32_t element) const {
  const auto& flux = solution.elements.at(element).flux;
  std::array<double, 3> watts{};
  for (std::size_t c = 0; c < 3; ++c) watts[c] = static_cast<double>(flux[c]) * watts_per_quantum;
  return watts;
}

SolvedScene solve_scene(RenderCase render_case) {
  const Scene scene = load_scene(render_case.scene, {});
  return solve_scene(scene, std::move(render_case));
}

SolvedScene solve_scene(const Scene& scene, RenderCase render_case) {
  const testing_support::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "solved.radiosity";
  render_case.files.save_radiosity = file;
  const Quality& quality = render_case.quality;
  const Camera camera = render_case.camera ? *render_case.camera : scene.camera.value();
  SolvedScene result{scene, {}, 0, {}, {}};
  result.figures = render(scene, camera, quality, render_case.machine, render_case.files, pe_image(), {}).figures;
  const SavedRadiosity saved = read_radiosity(file);
  result.mesh = make_mesh(scene, mesh_choice(quality, saved.splits));
  result.watts_per_quantum = light_units(scene, result.mesh, quality.two_sided_lights).watts_per_quantum;
  result.solution = unpack_radiosity(saved, radiosity_origin(scene, quality, result.mesh), result.mesh);
  return result;
}

}  // namespace torolux::test
