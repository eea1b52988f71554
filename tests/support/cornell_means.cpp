// SPDX-License-Identifier: MIT
// Flux of an element times its reflectance, over pi and its area; means over each quadrilateral are weighted by area.
#include "tests/support/cornell_means.hpp"

#include <numbers>

namespace torolux::test {
namespace {

std::array<double, 3> element_radiance(const SolvedScene& cornell, const MeshPatch& patch, std::uint32_t element) {
  const auto flux = cornell.incident_flux(patch.first_element[0] + element);
  const double area = cornell.mesh.element_area(patch, element);
  std::array<double, 3> radiance{};
  for (std::size_t c = 0; c < 3; ++c) {
    radiance[c] = flux[c] * cornell.scene.materials[patch.material].diffuse[c] / (area * std::numbers::pi);
  }
  return radiance;
}

}  // namespace

std::array<double, 3> radiance_at(const SolvedScene& cornell, std::uint32_t triangle, float b1, float b2) {
  const Mesh& mesh = cornell.mesh;
  const std::uint32_t facet = mesh.facet_at(triangle, b1, b2);
  for (const MeshPatch& patch : mesh.patches) {
    if (facet - patch.first_facet < patch.facets) return element_radiance(cornell, patch, mesh.facets[facet].element);
  }
  return {};
}

std::vector<std::array<double, 3>> mean_radiance(const SolvedScene& cornell) {
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
