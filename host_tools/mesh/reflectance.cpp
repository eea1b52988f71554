// SPDX-License-Identifier: MIT
// Facet by facet, weighted by area, with texture means from halved images (textures.hpp); what leaves are fractions of
// 2^32, at most 0.995.
#include "host_tools/mesh/reflectance.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

std::array<std::uint32_t, 3> in_fractions(const Vec3d& reflectance) {
  std::array<std::uint32_t, 3> result{};
  for (std::size_t c = 0; c < 3; ++c) {
    result[c] = static_cast<std::uint32_t>(std::llround(std::ldexp(std::clamp(reflectance[c], 0.0, 0.995), 32)));
  }
  return result;
}

/// A facet's corners in the texture.
std::array<protocol::TexturePoint, 3> texture_points(const Mesh& mesh, const MeshFacet& facet) {
  const protocol::GridTriangle grid = protocol::grid_triangle_of(facet.code);
  const std::uint32_t first = mesh.triangles[facet.triangle].texture_points;
  std::array<protocol::TexturePoint, 3> corners{};
  for (std::size_t i = 0; i < 3; ++i) {
    double u = 0;
    double v = 0;
    for (std::size_t w = 0; w < 3; ++w) {
      const double weight = std::ldexp(grid.corner[i][w], -static_cast<int>(protocol::kMostLevels));
      u += weight * static_cast<double>(mesh.texture_points[first + w].u);
      v += weight * static_cast<double>(mesh.texture_points[first + w].v);
    }
    corners[i] = {static_cast<float>(u), static_cast<float>(v)};
  }
  return corners;
}

}  // namespace

void set_reflectances(const Scene& scene, Mesh& mesh) {
  const std::vector<TextureMeans> means(mesh.textures.begin(), mesh.textures.end());
  for (MeshPatch& patch : mesh.patches) {
    Vec3d reflectance = scene.materials[patch.material].diffuse;
    const std::uint32_t texture = mesh.triangles[mesh.facets[patch.first_facet].triangle].texture;
    if (texture != protocol::kNoTexture) {
      Vec3d mean{0, 0, 0};
      for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
        const Vec3d here = means[texture].over(texture_points(mesh, mesh.facets[f]));
        mean = vec::add(mean, vec::scale(here, mesh.facet_area(mesh.facets[f]) / patch.area));
      }
      for (std::size_t c = 0; c < 3; ++c) reflectance[c] *= mean[c];
    }
    patch.reflectance = in_fractions(reflectance);
  }
}

}  // namespace torolux
