// SPDX-License-Identifier: MIT
// Cosine-distributed rays from points all over the element; each brings the radiance of what it sees, as far as that
// has been shot: what waits to be shot has not come yet.
#include "host_tools/inspect/light_sources.hpp"

#include <algorithm>
#include <map>
#include <numbers>

#include "host_tools/inspect/element_view.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// Facets of one element, chosen by area.
class ElementPoints {
 public:
  ElementPoints(const Mesh& mesh, const ElementPlace& place) : mesh_(mesh), back_(place.side == 1) {
    const MeshPatch& patch = mesh.patches[place.patch];
    for (std::uint32_t i = 0; i < patch.facets; ++i) {
      const MeshFacet& facet = mesh.facets[patch.first_facet + i];
      if (facet.element != place.element) continue;
      area_ += mesh.facet_area(facet);
      facets_.emplace_back(area_, &facet);
    }
  }

  SampleRay ray(Chance& chance) const {
    const double at = chance.uniform() * area_;
    auto chosen = std::ranges::upper_bound(facets_, at, {}, &std::pair<double, const MeshFacet*>::first);
    if (chosen == facets_.end()) --chosen;
    const MeshFacet& facet = *chosen->second;
    const auto corner = grid_corners(mesh_.triangles[facet.triangle], facet.sends_from.value_or(facet.code));
    double b = chance.uniform(), c = chance.uniform();
    if (b + c > 1) b = 1 - b, c = 1 - c;
    Vec3d place{};
    for (std::size_t i = 0; i < 3; ++i) place[i] = (1 - b - c) * corner[0][i] + b * corner[1][i] + c * corner[2][i];
    const Vec3d normal = normal_of(mesh_.triangles[facet.triangle]);
    return {place, chance.cosine_direction(back_ ? vec::scale(normal, -1) : normal)};
  }

 private:
  const Mesh& mesh_;
  bool back_;
  double area_ = 0;
  std::vector<std::pair<double, const MeshFacet*>> facets_;  // with the sum of areas up to and with this one
};

/// Radiance that has left an element in shots.
struct Sent {
  Vec3d emitted{}, reflected{};
};

Sent sent_by(const Scene& scene, const RenderSetup& setup, const Solution& solution, const SeenElement& seen) {
  Sent sent;
  const MeshPatch& patch = setup.mesh.patches[seen.patch];
  if (!seen.element) return sent;
  const SolvedSide& side = solution.sides[patch.side[seen.side]];
  const double area = setup.mesh.element_area(patch, *seen.element - patch.first_element[seen.side]);
  const Vec3d flux = watts_of(solution.elements[*seen.element].flux, setup.units);
  const protocol::Flux emission = patch_emission(scene, patch, seen.side, setup.units);
  const Vec3d emitted = emitted_radiance(scene, patch, seen.side, setup.units);
  const Vec3d reflectance = reflectance_of(patch);
  const auto share = [](std::int64_t part, std::int64_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
  };
  for (std::size_t c = 0; c < 3; ++c) {
    sent.emitted[c] = emitted[c] * share(emission[c] - side.emission[c], emission[c]);
    if (area > 0)
      sent.reflected[c] = reflectance[c] * flux[c] / area / std::numbers::pi * share(side.shot[c], side.incident[c]);
  }
  return sent;
}

}  // namespace

std::vector<LightSource> light_sources(const Scene& scene, const RenderSetup& setup, const Solution& solution,
                                       const ElementPlace& place) {
  SurfaceRays surfaces(scene, setup.mesh, setup.placement);
  const ElementPoints points(setup.mesh, place);
  const double watts =
      std::numbers::pi * setup.mesh.element_area(setup.mesh.patches[place.patch], place.element) / kSourceRays;
  std::map<std::uint32_t, LightSource> by_patch;
  Chance chance;
  for (std::uint32_t i = 0; i < kSourceRays; ++i) {
    const Sight sight = surfaces.along(points.ray(chance));
    if (!sight.element) continue;
    const Sent sent = sent_by(scene, setup, solution, *sight.element);
    LightSource& source = by_patch[sight.element->patch];
    for (std::size_t c = 0; c < 3; ++c) {
      source.emitted[c] += sight.weight[c] * sent.emitted[c] * watts;
      source.reflected[c] += sight.weight[c] * sent.reflected[c] * watts;
    }
  }
  std::vector<LightSource> sources;
  for (auto& [patch, source] : by_patch) {
    if (!(source.sum() > 0)) continue;
    source.patch = patch;
    source.material = scene.materials[setup.mesh.patches[patch].material].name;
    source.pe = setup.placement.patch_home[patch].pe;
    sources.push_back(std::move(source));
  }
  std::ranges::stable_sort(sources, std::greater<>(), &LightSource::sum);
  return sources;
}

}  // namespace torolux
