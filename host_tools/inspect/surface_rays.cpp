// SPDX-License-Identifier: MIT
// Walks as the predictions do. Glass is gone straight through, as thin panes are; of what it mirrors nothing is seen.
#include "host_tools/inspect/surface_rays.hpp"

#include <algorithm>
#include <string>

#include "emulator/errors.hpp"
#include "host_tools/report/text.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {

SurfaceRays::SurfaceRays(const Scene& scene, const Mesh& mesh, const Placement& placement)
    : scene_(scene), mesh_(mesh), placement_(placement), cost_(mesh, placement, sample_) {}

Sight SurfaceRays::along(const CameraRay& ray) {
  const auto start = first_subspace(placement_.grid, ray.origin, ray.direction, nullptr);
  if (!start) return {};
  return along({to_double(ray.origin), to_double(ray.direction)}, placement_.grid.cell(start->cell));
}

Sight SurfaceRays::along(const SampleRay& ray) {
  return along(ray, cost_.cell_of(ray.origin));
}

Sight SurfaceRays::along(SampleRay ray, PathCost::Cell cell) {
  cost_.begin(1, cell);
  Sight sight;
  for (std::uint32_t turns = 0; turns <= kMostTurns; ++turns) {
    const Meeting met = cost_.walk(ray, cell);
    if (met.triangle == nullptr) return sight;
    if (!sight.first_cell) sight.first_cell = placement_.grid.index(cell);
    const SceneMaterial& material = scene_.materials[met.triangle->material];
    if (material.kind == SurfaceKind::diffuse) {
      sight.element = element_at(met, ray.direction);
      return sight;
    }
    ray.origin = vec::add(ray.origin, vec::scale(ray.direction, met.t));
    turn(ray, *met.triangle, material, sight.weight);
  }
  return sight;
}

void SurfaceRays::turn(SampleRay& ray, const MeshTriangle& triangle, const SceneMaterial& material,
                       Vec3d& weight) const {
  const bool mirror = material.kind == SurfaceKind::mirror;
  if (mirror) ray.direction = mirrored(ray.direction, normal_of(triangle));
  const Vec3d& left = mirror ? material.specular : material.transmittance;
  for (std::size_t c = 0; c < 3; ++c) weight[c] *= left[c];
}

SeenElement SurfaceRays::element_at(const Meeting& met, const Vec3d& direction) const {
  const auto triangle = static_cast<std::uint32_t>(met.triangle - mesh_.triangles.data());
  const std::uint32_t facet = mesh_.facet_at(triangle, static_cast<float>(met.b1), static_cast<float>(met.b2));
  const auto behind = std::ranges::upper_bound(mesh_.patches, facet, {}, &MeshPatch::first_facet);
  const MeshPatch& patch = *std::prev(behind);
  SeenElement seen{triangle, static_cast<std::uint32_t>(&patch - mesh_.patches.data()), 0, std::nullopt};
  seen.side = vec::dot(normal_of(*met.triangle), direction) < 0 ? 0 : 1;
  if (patch.first_element[seen.side] != protocol::kNoSide)
    seen.element = patch.first_element[seen.side] + mesh_.facets[facet].element;
  return seen;
}

ElementPlace place_of_element(const Mesh& mesh, std::uint32_t element) {
  for (std::uint32_t number = 0; number < mesh.patches.size(); ++number) {
    const MeshPatch& patch = mesh.patches[number];
    for (std::uint32_t side = 0; side < 2; ++side) {
      const std::uint32_t first = patch.first_element[side];
      if (first != protocol::kNoSide && element >= first && element - first < patch.elements)
        return {number, side, element - first};
    }
  }
  throw InputError("there is no element " + std::to_string(element) + ": the scene has " + grouped(mesh.elements) +
                   ", counted from 0");
}

}  // namespace torolux
