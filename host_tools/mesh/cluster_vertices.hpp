// SPDX-License-Identifier: MIT
// Light at the vertices of clusters. Enters: the flux of their elements; leaves: sums for each vertex, and how the
// light there depends on the normal.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host_tools/mesh/irradiance_fit.hpp"
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

/// A cluster spans many triangles that do not face alike, so each vertex finds from the clusters near it how irradiance
/// varies with place and normal: without that, clusters would show as flat spots.
class ClusterVertices {
 public:
  explicit ClusterVertices(const Mesh& mesh) : mesh_(mesh) {}

  /// A facet of a cluster: its corners' vertices, and the flux of its element.
  void add(const MeshPatch& patch, std::uint32_t facet, const std::array<std::uint32_t, 3>& corners,
           const protocol::Flux& flux);
  /// Adds to the sums of all vertices that facets of clusters have, once all have been added.
  void smooth(std::vector<VertexSum>& sums);
  /// Fits of irradiance in `smooth`.
  std::uint64_t fits() const { return vertices_.size(); }
  /// Irradiance at a vertex of a cluster's facet with this normal, where the vertex itself has so much.
  Vec3d facing(std::uint32_t vertex, const Vec3d& unit_normal, const Vec3d& irradiance) const;

 private:
  struct Cluster {
    Vec3d centre{0, 0, 0};      ///< [normalised], times area until `smooth`
    Vec3d normal{0, 0, 0};      ///< mean, likewise
    double area = 0;            ///< [user units^2]
    Vec3d irradiance{0, 0, 0};  ///< [quanta / user unit^2], flux until `smooth`
    std::vector<std::uint32_t> vertices;
  };
  struct Vertex {
    std::vector<std::uint32_t> touching;  ///< clusters; until `smooth`
    Vec3d place{0, 0, 0};                 ///< normalised
    Vec3d normal{0, 0, 0};                ///< of its facets, times their area until `smooth`
    IrradianceFit fit;
  };

  /// A cluster that counts at a vertex.
  struct Near {
    std::uint32_t cluster;
    Vec3d offset;  ///< of its centre, in units of the reach
    double weight;
  };
  struct Facet {
    std::uint32_t cluster;
    std::array<std::uint32_t, 3> vertex;  ///< into `vertices_`
    Vec3d normal;
    double area;  ///< [user units^2]
  };

  void link();
  std::vector<Near> near(const Vertex& vertex) const;
  void fit(Vertex& vertex) const;
  /// What was smoothed away of each cluster's own light is added again, itself smoothed ("twicing", Tukey 1977,
  /// "Exploratory data analysis").
  void make_up();

  const Mesh& mesh_;
  std::vector<Cluster> clusters_;
  std::vector<Facet> facets_;
  std::vector<std::vector<std::uint32_t>> beside_;  ///< by cluster: which meet it at a vertex
  std::vector<std::uint32_t> vertex_of_;            ///< by vertex of the surface: number of `vertices_`, or kNoSide
  std::vector<Vertex> vertices_;
  std::uint32_t last_patch_ = protocol::kNoSide;
  std::uint32_t last_element_ = 0;
};

}  // namespace torolux
