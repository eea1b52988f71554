// SPDX-License-Identifier: MIT
// Light at the vertices of clusters. Enters: the flux of their elements; leaves: sums for each vertex, and how the
// light there depends on the normal.
#pragma once

#include <span>
#include <vector>

#include "host_tools/irradiance/cluster_vertices.hpp"
#include "host_tools/irradiance/irradiance_fit.hpp"

namespace torolux {

class ClusterLight {
 public:
  /// flux: by global element [quanta]. vertices: finished; outlive this.
  ClusterLight(const ClusterVertices& vertices, std::span<const protocol::Flux> flux);

  /// Adds to the flux of vertices of the surface: what goes with ClusterVertices::add_areas.
  void add_flux(std::vector<Vec3d>& sums) const;
  /// Irradiance at a corner of a cluster's facet, where the vertex itself has so much [quanta / user unit^2].
  Vec3d facing(std::uint32_t facet, std::size_t corner, const Vec3d& irradiance) const;

 private:
  void fit();
  /// What was smoothed away of each cluster's own light is added again, itself smoothed ("twicing", Tukey 1977,
  /// "Exploratory data analysis").
  void add_residual();

  const ClusterVertices& of_;
  std::vector<Vec3d> irradiance_;    ///< by cluster [quanta / user unit^2]
  std::vector<IrradianceFit> fits_;  ///< by vertex
};

}  // namespace torolux
