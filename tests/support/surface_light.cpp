// SPDX-License-Identifier: MIT
// By the path tracer: paths shared out by area to triangles and their lit sides, flux and variance added up. In a
// solution: the flux of the elements of each group.
#include "tests/support/surface_light.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "firmware/protocol/triangle_grid.hpp"
#include "tests/references/path_tracer.hpp"

namespace torolux::test {
namespace {

std::vector<double> areas_of_groups(const references::World& world, std::span<const std::uint32_t> group) {
  std::vector<double> areas(group.empty() ? 0 : std::size_t{*std::ranges::max_element(group)} + 1, 0);
  for (std::size_t t = 0; t < group.size(); ++t) areas[group[t]] += world.triangles()[t].area;
  return areas;
}

/// Adds what `count` (> 1) paths from one side of a triangle find.
void add_side(const references::World& world, std::uint32_t number, bool front, std::uint32_t count,
              GroupLight& light) {
  references::Samples samples(front ? 1 : 2, number);
  references::Colour sum = references::Colour::Zero();
  references::Colour squares = references::Colour::Zero();
  for (std::uint32_t i = 0; i < count; ++i) {
    samples.begin(i);
    const auto [u, v] = samples.pair(0);
    const double root = std::sqrt(u);
    const references::Colour value = references::incident_over_pi(
        world, world.at(number, root * (1 - v), root * v, front), references::LightFinding::both, samples);
    sum += value;
    squares += value * value;
  }
  const double scale = std::numbers::pi * world.triangles()[number].area / count;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto i = static_cast<Eigen::Index>(c);
    light.flux[c] += scale * sum[i];
    light.variance[c] += scale * scale * (squares[i] - sum[i] * sum[i] / count);
  }
}

}  // namespace

double GroupLight::all() const {
  return std::accumulate(flux.begin(), flux.end(), 0.0);
}

double GroupLight::relative_noise() const {
  double deviation = 0;
  for (const double channel : variance) deviation += std::sqrt(channel);
  return deviation / all();
}

double GroupLight::relative_noise(std::size_t channel) const {
  return std::sqrt(variance.at(channel)) / flux.at(channel);
}

std::vector<GroupLight> traced_light(const references::World& world, const Mesh& mesh,
                                     std::span<const std::uint32_t> group, std::span<const std::uint32_t> paths) {
  const std::vector<double> areas = areas_of_groups(world, group);
  std::vector<GroupLight> light(areas.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t g = group[t];
    if (paths[g] == 0) continue;
    const auto count = static_cast<std::uint32_t>(std::ceil(world.triangles()[t].area / areas[g] * paths[g])) + 8;
    for (const bool front : {true, false}) {
      const std::uint32_t present = front ? protocol::kFrontPresent : protocol::kBackPresent;
      if ((mesh.triangles[t].sides & present) != 0) add_side(world, t, front, count, light[g]);
    }
  }
  return light;
}

std::vector<std::uint32_t> paths_by_area(const references::World& world, std::span<const std::uint32_t> group,
                                         std::uint32_t paths) {
  const std::vector<double> areas = areas_of_groups(world, group);
  const double all = std::accumulate(areas.begin(), areas.end(), 0.0);
  std::vector<std::uint32_t> shares;
  shares.reserve(areas.size());
  for (const double area : areas) shares.push_back(static_cast<std::uint32_t>(std::ceil(area / all * paths)));
  return shares;
}

std::vector<GroupLight> solved_light(const SolvedScene& solved, std::span<const std::uint32_t> group) {
  std::vector<GroupLight> light(*std::ranges::max_element(group) + std::size_t{1});
  for (const MeshPatch& patch : solved.mesh.patches) {
    GroupLight& sum = light[group[solved.mesh.facets[patch.first_facet].triangle]];
    for (const std::uint32_t first : patch.first_element) {
      if (first == protocol::kNoSide) continue;
      for (std::uint32_t e = 0; e < patch.elements; ++e) {
        const auto watts = solved.incident_flux(first + e);
        for (std::size_t c = 0; c < 3; ++c) sum.flux[c] += watts[c];
      }
    }
  }
  return light;
}

}  // namespace torolux::test
