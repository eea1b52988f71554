// SPDX-License-Identifier: MIT
// See cluster_vertices.hpp.
#include "host_tools/mesh/cluster_vertices.hpp"

#include <algorithm>

#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// Clusters count that are nearer than so many elements' lengths: about a dozen. Fewer follow noise, more blur.
constexpr double kReach = 1.5;

void sort_unique(std::vector<std::uint32_t>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace

void ClusterVertices::add(const MeshPatch& patch, std::uint32_t facet, const std::array<std::uint32_t, 3>& corners,
                          const protocol::Flux& flux) {
  const MeshFacet& here = mesh_.facets[facet];
  if (last_patch_ != patch.first_facet || last_element_ != here.element) {
    Cluster& fresh = clusters_.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) fresh.irradiance[k] = static_cast<double>(flux[k]);
    last_patch_ = patch.first_facet;
    last_element_ = here.element;
  }
  Cluster& cluster = clusters_.back();
  const double area = mesh_.facet_area(here);
  const Vec3d unit_normal = mesh_.facet_normal(here);
  const Vec3d normal = vec::scale(unit_normal, area);
  const auto places = grid_corners(mesh_.triangles[here.triangle], here.code);
  const auto number = static_cast<std::uint32_t>(clusters_.size() - 1);
  Facet& added = facets_.emplace_back(Facet{number, {}, unit_normal, area});
  for (std::size_t c = 0; c < 3; ++c) {
    if (corners[c] >= vertex_of_.size()) vertex_of_.resize(corners[c] + 1, protocol::kNoSide);
    std::uint32_t& v = vertex_of_[corners[c]];
    if (v == protocol::kNoSide) {
      v = static_cast<std::uint32_t>(vertices_.size());
      vertices_.emplace_back().place = places[c];
    }
    vertices_[v].normal = vec::add(vertices_[v].normal, normal);
    vertices_[v].touching.push_back(number);
    cluster.centre = vec::add(cluster.centre, vec::scale(places[c], area / 3));
    cluster.vertices.push_back(v);
    added.vertex[c] = v;
  }
  cluster.normal = vec::add(cluster.normal, normal);
  cluster.area += area;
}

void ClusterVertices::link() {
  for (Vertex& vertex : vertices_) {
    sort_unique(vertex.touching);
    if (vec::length(vertex.normal) > 0) vertex.normal = vec::unit(vertex.normal);
  }
  beside_.resize(clusters_.size());
  for (std::uint32_t c = 0; c < clusters_.size(); ++c) {
    Cluster& cluster = clusters_[c];
    cluster.centre = vec::scale(cluster.centre, 1 / cluster.area);
    cluster.normal = vec::scale(cluster.normal, 1 / cluster.area);
    cluster.irradiance = vec::scale(cluster.irradiance, 1 / cluster.area);
    for (const std::uint32_t v : cluster.vertices) {
      beside_[c].insert(beside_[c].end(), vertices_[v].touching.begin(), vertices_[v].touching.end());
    }
    sort_unique(beside_[c]);
  }
}

std::vector<ClusterVertices::Near> ClusterVertices::near(const Vertex& vertex) const {
  const double reach = kReach * mesh_.lengths.cluster * mesh_.space.scale;
  // Light does not pass from one cluster to another that it does not touch.
  std::vector<std::uint32_t> seen = vertex.touching;
  std::vector<Near> found;
  for (std::size_t n = 0; n < seen.size(); ++n) {
    const Cluster& cluster = clusters_[seen[n]];
    const Vec3d offset = vec::scale(vec::subtract(cluster.centre, vertex.place), 1 / reach);
    const double far = vec::length(offset);
    const double close = far < 1 ? (1 - far * far) * (1 - far * far) : 0;
    const double length = vec::length(cluster.normal);
    const double alike = length > 0 ? std::max(0.0, vec::dot(cluster.normal, vertex.normal) / length) : 0;
    const bool touches = n < vertex.touching.size();
    // A little of what it touches in any case: a cluster may be longer than its reach.
    const double weight = std::max(close * alike * alike, touches ? 1e-3 : 0.0) * cluster.area;
    if (!(weight > 0)) continue;
    found.push_back({seen[n], offset, weight});
    for (const std::uint32_t other : beside_[seen[n]]) {
      if (std::find(seen.begin(), seen.end(), other) == seen.end()) seen.push_back(other);
    }
  }
  return found;
}

void ClusterVertices::fit(Vertex& vertex) const {
  std::vector<IrradianceSample> samples;
  for (const Near& at : near(vertex)) {
    const Cluster& cluster = clusters_[at.cluster];
    samples.push_back({cluster.normal, at.offset, cluster.irradiance, at.weight});
  }
  vertex.fit = fit_irradiance(samples);
}

void ClusterVertices::make_up() {
  std::vector<Vec3d> missing;
  for (const Cluster& cluster : clusters_) missing.push_back(cluster.irradiance);
  for (const Facet& facet : facets_) {
    const double share = facet.area / clusters_[facet.cluster].area / 3;
    for (const std::uint32_t v : facet.vertex) {
      missing[facet.cluster] =
          vec::subtract(missing[facet.cluster], vec::scale(vertices_[v].fit.facing(facet.normal), share));
    }
  }
  for (Vertex& vertex : vertices_) {
    Vec3d sum{0, 0, 0};
    double weight = 0;
    for (const Near& at : near(vertex)) {
      sum = vec::add(sum, vec::scale(missing[at.cluster], at.weight));
      weight += at.weight;
    }
    vertex.fit.value = vec::add(vertex.fit.value, vec::scale(sum, 1 / weight));
  }
}

void ClusterVertices::smooth(std::vector<VertexSum>& sums) {
  link();
  for (Vertex& vertex : vertices_) fit(vertex);
  make_up();
  vertex_of_.resize(sums.size(), protocol::kNoSide);
  for (std::size_t v = 0; v < sums.size(); ++v) {
    if (vertex_of_[v] == protocol::kNoSide) continue;
    Vertex& vertex = vertices_[vertex_of_[v]];
    double area = 0;
    for (const std::uint32_t c : vertex.touching) area += clusters_[c].area;
    vertex.touching = {};  // a dense mesh has many vertices
    const Vec3d light = vertex.fit.facing(vertex.normal);
    sums[v].flux = vec::add(sums[v].flux, vec::scale(light, area));
    sums[v].area += area;
  }
}

Vec3d ClusterVertices::facing(std::uint32_t vertex, const Vec3d& unit_normal, const Vec3d& irradiance) const {
  const Vertex& at = vertices_[vertex_of_[vertex]];
  const Vec3d more = vec::subtract(at.fit.facing(unit_normal), at.fit.facing(at.normal));
  const Vec3d light = vec::add(irradiance, more);
  return {std::max(0.0, light[0]), std::max(0.0, light[1]), std::max(0.0, light[2])};
}

}  // namespace torolux
