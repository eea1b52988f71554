// SPDX-License-Identifier: MIT
// See settings.hpp.
#include "tests/accuracy/settings.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/mesh/mesh.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux::accuracy {
namespace {

/// The longest edges of patches and elements of the scene's diffuse triangles, a little longer for rounding.
struct Lengths {
  double patch = 0, element = 0;
};

Lengths lengths_of(const Scene& scene, const Quality& quality) {
  Lengths lengths;
  const Mesh mesh = make_mesh(scene, {quality.patch_length, quality.element_length, quality.two_sided_lights});
  for (const MeshTriangle& triangle : mesh.triangles) {
    if (triangle.sides == 0) continue;
    double edge = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      edge = std::fmax(edge, vec::length(vec::subtract(scene.positions[triangle.position[i]],
                                                       scene.positions[triangle.position[(i + 1) % 3]])));
    }
    lengths.patch = std::fmax(lengths.patch, std::ldexp(edge, -int{triangle.patch_level}) * (1 + 1e-6));
    lengths.element = std::fmax(lengths.element, std::ldexp(edge, -int{triangle.element_level}) * (1 + 1e-6));
  }
  return lengths;
}

}  // namespace

Quality quality_at(const Setting& setting, const Quality& settled, const Scene& scene) {
  Quality quality = settled;
  if (setting.length != 1) {
    const Lengths lengths = lengths_of(scene, settled);
    quality.patch_length = settled.patch_length.value_or(lengths.patch) * setting.length;
    quality.element_length = settled.element_length.value_or(lengths.element) * setting.length;
  }
  quality.hemicube = std::max(4U, settled.hemicube * setting.hemicube_percent / 200 * 2);
  if (setting.shot_points > 0) quality.shot_points = setting.shot_points;
  quality.unshot *= setting.unshot;
  quality.samples = std::max(1U, settled.samples * setting.samples_percent / 100);
  return quality;
}

}  // namespace torolux::accuracy
