// SPDX-License-Identifier: MIT
// See cornell_means.hpp.
#include "tests/support/cornell_means.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "host_tools/render/setup.hpp"
#include "host_tools/solution/radiosity_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {

CornellSolution solve_cornell(RenderCase cornell) {
  const testing_support::TemporaryFolder folder;
  cornell.files.save_radiosity = folder.path() / "cornell.radiosity";
  CornellSolution result{load_scene(cornell.scene, {}), {}, 0, {}, run_case(cornell).figures};
  const SavedRadiosity saved = read_radiosity(*cornell.files.save_radiosity);
  result.mesh = make_mesh(result.scene, mesh_choice(cornell.quality, saved.splits));
  result.watts_per_quantum = light_units(result.scene, result.mesh, false).watts_per_quantum;
  result.solution = unpack_radiosity(saved, radiosity_origin(result.scene, cornell.quality, result.mesh), result.mesh);
  return result;
}

namespace {

std::array<double, 3> element_radiance(const CornellSolution& cornell, const MeshPatch& patch, std::uint32_t element) {
  const auto& flux = cornell.solution.elements.at(patch.first_element[0] + element).flux;
  const double area = cornell.mesh.element_area(patch, element);
  std::array<double, 3> radiance{};
  for (std::size_t c = 0; c < 3; ++c) {
    radiance[c] = static_cast<double>(flux[c]) * cornell.watts_per_quantum *
                  cornell.scene.materials[patch.material].diffuse[c] / (area * std::numbers::pi);
  }
  return radiance;
}

}  // namespace

std::array<double, 3> radiance_at(const CornellSolution& cornell, std::uint32_t triangle, float b1, float b2) {
  const Mesh& mesh = cornell.mesh;
  const std::uint32_t facet = mesh.facet_at(triangle, b1, b2);
  for (const MeshPatch& patch : mesh.patches) {
    if (facet - patch.first_facet < patch.facets) return element_radiance(cornell, patch, mesh.facets[facet].element);
  }
  return {};
}

std::vector<std::array<double, 3>> mean_radiance(const CornellSolution& cornell) {
  std::vector<std::array<double, 3>> means(cornell.mesh.triangles.size() / 2);
  std::vector<double> area(means.size(), 0);
  for (const MeshPatch& patch : cornell.mesh.patches) {
    const std::size_t quad = cornell.mesh.facets[patch.first_facet].triangle / 2;
    for (std::uint32_t e = 0; e < patch.elements; ++e) {
      const double here = cornell.mesh.element_area(patch, e);
      const auto radiance = element_radiance(cornell, patch, e);
      for (std::size_t c = 0; c < 3; ++c) means[quad][c] += radiance[c] * here;
      area[quad] += here;
    }
  }
  for (std::size_t q = 0; q < means.size(); ++q) {
    for (double& value : means[q]) value /= area[q];
  }
  return means;
}

}  // namespace torolux::test
