// SPDX-License-Identifier: MIT
// What of the light filter depends on the mesh alone. Enters: the flat elements of one side; leaves: where they meet,
// how irradiance bends there, and which vertices are free.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/protocol/element_light.hpp"
#include "host_tools/irradiance/surface_vertices.hpp"
#include "host_tools/mesh/mesh.hpp"

namespace torolux {

class FilterPlan {
 public:
  using Hanging = SurfaceVertices::Hanging;

  /// An element that is one flat triangle, all of it seen.
  struct Triangle {
    std::uint32_t element;                ///< global
    std::array<std::uint32_t, 3> corner;  ///< vertices
    double area;                          ///< [user units^2]
    protocol::ConcaveCorners concave;
    std::array<double, 3> of_mean;  ///< how much of each corner's light its mean is
  };
  /// An edge where two of them meet. Irradiance bends there by the sum of its values, each times its `of`.
  struct Bend {
    std::array<std::uint32_t, 6> vertex;    ///< the first triangle's corners, then those of the second that it lacks
    std::array<double, 6> of;               ///< [1 / user unit]; 0 where there are no more vertices
    double curvature;                       ///< times the bend's square: its part of the integral of squared curvature
    std::array<std::uint32_t, 2> triangle;  ///< into triangles()
  };
  /// A facet that is an element of its own. corner: its vertices; element: global.
  void add(const Mesh& mesh, std::uint32_t facet, std::uint32_t element, const std::array<std::uint32_t, 3>& corner,
           protocol::ConcaveCorners concave);
  /// Once all have been added. kept: by vertex, whether it keeps the light that it has. hanging: larger elements come
  /// first.
  void finish(const std::vector<bool>& kept, std::vector<Hanging> hanging);

  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<Bend>& bends() const { return bends_; }
  const std::vector<Hanging>& hanging() const { return hanging_; }
  /// Vertices whose light may change.
  const std::vector<std::uint32_t>& free() const { return free_; }

 private:
  struct Edge;

  std::vector<Edge> sorted_edges() const;
  void find_bends();
  void find_part_of_longer(const std::vector<Edge>& edges, const Edge& edge);
  void add_bend(const Edge& a, const Edge& b);
  void find_free(const std::vector<bool>& kept);

  std::vector<Triangle> triangles_;
  std::vector<std::array<Vec3d, 3>> places_;           ///< of their corners, until `finish` [user units]
  std::vector<std::array<std::uint32_t, 2>> between_;  ///< by vertex, until `finish`: where it hangs
  std::vector<Bend> bends_;
  std::vector<Hanging> hanging_;
  std::vector<std::uint32_t> free_;
};

}  // namespace torolux
