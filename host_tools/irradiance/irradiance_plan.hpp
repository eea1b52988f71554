// SPDX-License-Identifier: MIT
// What of vertex irradiance depends on the mesh alone. Enters: the mesh; leaves: which elements, vertices and weights
// make the light at each corner, so that with the elements' flux only sums are left to do (vertex_irradiance.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host_tools/irradiance/cluster_vertices.hpp"
#include "host_tools/irradiance/filter_plan.hpp"
#include "host_tools/irradiance/surface_vertices.hpp"
#include "host_tools/mesh/mesh.hpp"

namespace torolux {

/// Of one side of all surfaces. Vertices are those of SurfaceVertices, below `area.size()`; elements are global.
struct SidePlan {
  static constexpr std::uint32_t kNone = 0xFFFF'FFFFU;
  using Corners = std::array<std::uint32_t, 3>;
  using Hanging = SurfaceVertices::Hanging;

  struct Facet {
    std::uint32_t element;
    std::uint32_t triangle;  ///< of VertexIrradiance::triangles
    Corners corner;          ///< vertices
    std::uint32_t counts;    ///< bit c: its flux goes to corner c's sum; 0 where it is a cluster's
    protocol::ConcaveCorners concave;
    double of_element;                 ///< so much of the flux
    std::uint32_t of_cluster = kNone;  ///< number in `clusters`
    std::uint32_t of_hidden = kNone;   ///< into `hidden`
  };
  /// A vertex that takes the mean of others: `count` of `sources` from `first` on.
  struct Spread {
    std::uint32_t to, first, count;
  };
  struct Border {
    std::uint32_t vertex;
    /// Of the elements around it; on a concave edge, as far as light there makes their means [user units^2].
    double area;
  };
  /// A facet at such a vertex.
  struct BorderFacet {
    std::uint32_t element;
    Corners corner;
    Corners border;                 ///< into `borders`, or kNone
    double area;                    ///< [user units^2]
    std::array<double, 3> of_mean;  ///< how much of each corner's light its mean is
  };
  /// A vertex where both sides of a wall meet narrow elements: the lightest of all with the same `place` shows there.
  struct Lit {
    std::uint32_t vertex, place;
  };

  std::vector<Facet> facets;         ///< that are there on this side, in the order of the mesh
  std::vector<double> area;          ///< by vertex: what its flux is divided by [user units^2]; 0: dark
  std::vector<Hanging> anchored;     ///< all of them, larger elements first
  std::vector<Hanging> first_known;  ///< of those, whose ends are measured: before light spreads
  std::vector<Spread> spreads;       ///< in this order
  std::vector<std::uint32_t> sources;
  std::vector<Border> borders;
  std::vector<BorderFacet> border_facets;
  std::vector<Lit> lit;
  std::uint32_t lit_places = 0;
  std::vector<Corners> hidden;  ///< lit places of the corners of what lies under a thing
  ClusterVertices clusters;
  FilterPlan filter;  ///< of what no wall cuts
};

struct IrradiancePlan {
  explicit IrradiancePlan(const Mesh& mesh);

  std::array<SidePlan, 2> side;      ///< front, back
  std::vector<std::uint32_t> first;  ///< by facet: VertexIrradiance::first
  std::uint32_t triangles = 0;
};

}  // namespace torolux
