// SPDX-License-Identifier: MIT
// See cornell_means.hpp.
#include "tests/support/cornell_means.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/solution/radiosity_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {

CornellSolution solve_cornell(RenderCase cornell) {
  const testing_support::TemporaryFolder folder;
  cornell.files.save_radiosity = folder.path() / "cornell.radiosity";
  CornellSolution result{load_scene(cornell.scene, {}), {}, 0, {}, run_case(cornell).figures};
  result.mesh = make_mesh(result.scene, {cornell.quality.patch_length, cornell.quality.element_length, false});
  result.watts_per_quantum = light_units(result.scene, result.mesh, false).watts_per_quantum;
  result.solution = load_radiosity(*cornell.files.save_radiosity,
                                   radiosity_origin(result.scene, cornell.quality, result.mesh), result.mesh);
  return result;
}

std::array<double, 3> element_radiance(const CornellSolution& cornell, const MeshTriangle& triangle,
                                       std::uint32_t element) {
  const std::uint32_t elements = protocol::triangles_of_level(triangle.element_level);
  const auto& flux = cornell.solution.elements.at(triangle.first_element[0] + element).flux;
  std::array<double, 3> radiance{};
  for (std::size_t c = 0; c < 3; ++c) {
    radiance[c] = static_cast<double>(flux[c]) * cornell.watts_per_quantum *
                  cornell.scene.materials[triangle.material].diffuse[c] / (triangle.area / elements * std::numbers::pi);
  }
  return radiance;
}

std::vector<std::array<double, 3>> mean_radiance(const CornellSolution& cornell) {
  std::vector<std::array<double, 3>> means;
  for (std::size_t q = 0; 2 * q + 1 < cornell.mesh.triangles.size(); ++q) {
    std::array<double, 3> sum{};
    double area = 0;
    for (std::size_t t = 2 * q; t <= 2 * q + 1; ++t) {
      const MeshTriangle& triangle = cornell.mesh.triangles[t];
      const std::uint32_t elements = protocol::triangles_of_level(triangle.element_level);
      area += triangle.area;
      for (std::uint32_t e = 0; e < elements; ++e) {
        const auto radiance = element_radiance(cornell, triangle, e);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += radiance[c] * triangle.area / elements;
      }
    }
    for (double& value : sum) value /= area;
    means.push_back(sum);
  }
  return means;
}

}  // namespace torolux::test
