// SPDX-License-Identifier: MIT
// From each vertex a search goes from cluster to touching cluster, as far as they count: by distance, by how alike
// their normals are, and by area.
#include "host_tools/irradiance/cluster_vertices.hpp"

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

std::uint32_t ClusterVertices::add(const Mesh& mesh, std::uint32_t facet, const std::array<std::uint32_t, 3>& corners,
                                   std::uint32_t element) {
  const MeshFacet& here = mesh.facets[facet];
  if (clusters_.empty() || clusters_.back().element != element) {
    clusters_.emplace_back().element = element;
    vertices_of_.emplace_back();
  }
  Cluster& cluster = clusters_.back();
  const double area = mesh.facet_area(here);
  const Vec3d unit_normal = mesh.facet_normal(here);
  const Vec3d normal = vec::scale(unit_normal, area);
  const auto points = grid_corners(mesh.triangles[here.triangle], here.code);
  const auto number = static_cast<std::uint32_t>(clusters_.size() - 1);
  Facet& added = facets_.emplace_back(Facet{number, {}, unit_normal, area});
  for (std::size_t c = 0; c < 3; ++c) {
    if (corners[c] >= vertex_of_.size()) vertex_of_.resize(corners[c] + 1, protocol::kNoSide);
    std::uint32_t& v = vertex_of_[corners[c]];
    if (v == protocol::kNoSide) {
      v = static_cast<std::uint32_t>(vertices_.size());
      vertices_.emplace_back().surface_vertex = corners[c];
      places_.emplace_back().point = points[c];
    }
    vertices_[v].normal = vec::add(vertices_[v].normal, normal);
    places_[v].touching.push_back(number);
    cluster.centre = vec::add(cluster.centre, vec::scale(points[c], area / 3));
    vertices_of_.back().push_back(v);
    added.vertex[c] = v;
  }
  cluster.normal = vec::add(cluster.normal, normal);
  cluster.area += area;
  return static_cast<std::uint32_t>(facets_.size() - 1);
}

void ClusterVertices::link() {
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    sort_unique(places_[v].touching);
    Vertex& vertex = vertices_[v];
    if (vec::length(vertex.normal) > 0) vertex.normal = vec::unit(vertex.normal);
  }
  beside_.resize(clusters_.size());
  for (std::uint32_t c = 0; c < clusters_.size(); ++c) {
    Cluster& cluster = clusters_[c];
    cluster.centre = vec::scale(cluster.centre, 1 / cluster.area);
    cluster.normal = vec::scale(cluster.normal, 1 / cluster.area);
    for (const std::uint32_t v : vertices_of_[c]) {
      beside_[c].insert(beside_[c].end(), places_[v].touching.begin(), places_[v].touching.end());
    }
    sort_unique(beside_[c]);
  }
}

void ClusterVertices::find_near(const Mesh& mesh, Vertex& vertex, const Place& place) {
  double reach = kReach * mesh.lengths.cluster * mesh.space.scale;
  vertex.first_near = static_cast<std::uint32_t>(near_.size());
  const std::size_t most = std::max(kMostNear, place.touching.size());
  while (!take_near(vertex, place, reach, most)) {
    near_.resize(vertex.first_near);
    reach /= 2;
  }
  vertex.near = static_cast<std::uint32_t>(near_.size()) - vertex.first_near;
}

bool ClusterVertices::take_near(const Vertex& vertex, const Place& place, double reach, std::size_t most) {
  ++search_;
  // Light does not pass from one cluster to another that it does not touch.
  seen_.clear();
  const auto see = [this](std::uint32_t cluster) {
    if (seen_in_[cluster] == search_) return;
    seen_in_[cluster] = search_;
    seen_.push_back(cluster);
  };
  for (const std::uint32_t cluster : place.touching) see(cluster);
  for (std::size_t n = 0; n < seen_.size(); ++n) {
    const Cluster& cluster = clusters_[seen_[n]];
    const Vec3d offset = vec::scale(vec::subtract(cluster.centre, place.point), 1 / reach);
    const double far = vec::length(offset);
    const double close = far < 1 ? (1 - far * far) * (1 - far * far) : 0;
    const double length = vec::length(cluster.normal);
    const double alike = length > 0 ? std::max(0.0, vec::dot(cluster.normal, vertex.normal) / length) : 0;
    const bool touches = n < place.touching.size();
    // A little of what it touches in any case: a cluster may be longer than its reach.
    const double weight = std::max(close * alike * alike, touches ? 1e-3 : 0.0) * cluster.area;
    if (!(weight > 0)) continue;
    if (near_.size() - vertex.first_near == most) return false;
    near_.push_back({seen_[n], offset, weight});
    for (const std::uint32_t other : beside_[seen_[n]]) see(other);
  }
  return true;
}

void ClusterVertices::finish(const Mesh& mesh) {
  link();
  seen_in_.assign(clusters_.size(), 0);
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    find_near(mesh, vertices_[v], places_[v]);
    for (const std::uint32_t c : places_[v].touching) vertices_[v].area += clusters_[c].area;
  }
  // A dense mesh has many.
  places_ = {};
  vertices_of_ = {};
  beside_ = {};
  vertex_of_ = {};
  seen_ = {};
  seen_in_ = {};
}

void ClusterVertices::add_areas(std::vector<double>& areas) const {
  for (const Vertex& vertex : vertices_) areas[vertex.surface_vertex] += vertex.area;
}

}  // namespace torolux
