// SPDX-License-Identifier: MIT
// Light at the vertices of clusters. Enters: the flux of their elements; leaves: sums for each vertex.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host_tools/mesh/mesh.hpp"

namespace torolux {

/// Flux and area of the elements around a vertex.
struct VertexSum {
  Vec3d flux{0, 0, 0};  ///< [quanta]
  double area = 0;      ///< [user units^2]

  void add(const protocol::Flux& more, double more_area) {
    for (std::size_t c = 0; c < 3; ++c) flux[c] += static_cast<double>(more[c]);
    area += more_area;
  }
  Vec3d irradiance() const {
    if (!(area > 0)) return {0, 0, 0};
    return {flux[0] / area, flux[1] / area, flux[2] / area};
  }
};

/// A cluster spans many triangles, so each vertex takes the light of all elements that meet one of its triangles'
/// corners, weighted by how near their centres are: without that, clusters would show as flat spots.
class ClusterVertices {
 public:
  explicit ClusterVertices(const Mesh& mesh) : mesh_(mesh) {}

  /// A facet of a cluster: its corners' vertices, and the flux of its element.
  void add(const MeshPatch& patch, std::uint32_t facet, const std::array<std::uint32_t, 3>& corners,
           const protocol::Flux& flux);
  /// Adds to the sums of all vertices that facets of clusters have.
  void smooth(std::vector<VertexSum>& sums) const;

 private:
  struct Cluster {
    Vec3d centre{0, 0, 0};  ///< [normalised], times area until `smooth`
    double area = 0;        ///< [user units^2]
    protocol::Flux flux{};
    std::vector<std::uint32_t> vertices;
  };
  struct Corner {
    std::uint32_t vertex;
    std::uint32_t cluster;
    Vec3d place;  ///< normalised
  };

  const Mesh& mesh_;
  std::vector<Cluster> clusters_;
  std::vector<Corner> corners_;
  std::uint32_t last_patch_ = protocol::kNoSide;
  std::uint32_t last_element_ = 0;
};

}  // namespace torolux
