// SPDX-License-Identifier: MIT
// See cluster_vertices.hpp.
#include "host_tools/mesh/cluster_vertices.hpp"

#include <algorithm>

#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

void sort_unique(std::vector<std::uint32_t>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace

void ClusterVertices::add(const MeshPatch& patch, std::uint32_t facet, const std::array<std::uint32_t, 3>& corners,
                          const protocol::Flux& flux) {
  const MeshFacet& here = mesh_.facets[facet];
  if (last_patch_ != patch.first_facet || last_element_ != here.element) {
    clusters_.emplace_back().flux = flux;
    last_patch_ = patch.first_facet;
    last_element_ = here.element;
  }
  Cluster& cluster = clusters_.back();
  const double area = mesh_.facet_area(here);
  const auto places = grid_corners(mesh_.triangles[here.triangle], here.code);
  for (std::size_t c = 0; c < 3; ++c) {
    cluster.centre = vec::add(cluster.centre, vec::scale(places[c], area / 3));
    cluster.vertices.push_back(corners[c]);
    corners_.push_back({corners[c], static_cast<std::uint32_t>(clusters_.size() - 1), places[c]});
  }
  cluster.area += area;
}

void ClusterVertices::smooth(std::vector<VertexSum>& sums) const {
  std::vector<std::vector<std::uint32_t>> touching(sums.size());  // clusters, by vertex
  std::vector<Vec3d> place(sums.size());
  for (const Corner& corner : corners_) {
    touching[corner.vertex].push_back(corner.cluster);
    place[corner.vertex] = corner.place;
  }
  for (auto& clusters : touching) sort_unique(clusters);
  // Which clusters meet at some vertex: light does not pass from one to another that it does not touch.
  std::vector<std::vector<std::uint32_t>> beside(clusters_.size());
  for (std::uint32_t c = 0; c < clusters_.size(); ++c) {
    for (const std::uint32_t vertex : clusters_[c].vertices) {
      beside[c].insert(beside[c].end(), touching[vertex].begin(), touching[vertex].end());
    }
    sort_unique(beside[c]);
  }
  const double reach = mesh_.lengths.element * mesh_.space.scale;
  for (std::size_t v = 0; v < sums.size(); ++v) {
    std::vector<std::uint32_t> near;
    for (const std::uint32_t c : touching[v]) near.insert(near.end(), beside[c].begin(), beside[c].end());
    sort_unique(near);
    for (const std::uint32_t c : near) {
      const Cluster& cluster = clusters_[c];
      const double far = vec::length(vec::subtract(vec::scale(cluster.centre, 1 / cluster.area), place[v])) / reach;
      const bool touches = std::binary_search(touching[v].begin(), touching[v].end(), c);
      // A little of what it touches in any case: a cluster may be longer than its reach.
      const double close = far < 1 ? (1 - far * far) * (1 - far * far) : 0;
      const double weight = std::max(close, touches ? 1e-3 : 0.0);
      for (std::size_t k = 0; k < 3; ++k) sums[v].flux[k] += weight * static_cast<double>(cluster.flux[k]);
      sums[v].area += weight * cluster.area;
    }
  }
}

}  // namespace torolux
