// SPDX-License-Identifier: MIT
// The vertices of clusters. Enters: their facets; leaves: which clusters count at each vertex, and how much.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host_tools/mesh/mesh.hpp"

namespace torolux {

/// A cluster spans many triangles that do not face alike, so each vertex finds from the clusters near it how irradiance
/// varies with place and normal (cluster_light.hpp): without that, clusters would show as flat spots.
class ClusterVertices {
 public:
  struct Cluster {
    std::uint32_t element = 0;  ///< global
    Vec3d centre{0, 0, 0};      ///< [normalised], times area until `finish`
    Vec3d normal{0, 0, 0};      ///< mean, likewise
    double area = 0;            ///< [user units^2]
  };
  /// So many clusters count at a vertex at most, or those that touch it. Where more are near, as on a very dense mesh,
  /// whose clusters end at a number of triangles and not at a length, the reach is halved until they are no more: else
  /// all lists together would grow with the vertices times the clusters.
  static constexpr std::size_t kMostNear = 64;

  /// A cluster that counts at a vertex.
  struct Near {
    std::uint32_t cluster;
    Vec3d offset;  ///< of its centre, in units of the reach there
    double weight;
  };
  struct Vertex {
    std::uint32_t surface_vertex = 0;
    Vec3d normal{0, 0, 0};  ///< of its facets, times their area until `finish`
    double area = 0;        ///< of the clusters that it touches [user units^2]
    std::uint32_t first_near = 0, near = 0;
  };
  struct Facet {
    std::uint32_t cluster;
    std::array<std::uint32_t, 3> vertex;  ///< into vertices()
    Vec3d normal;
    double area;  ///< [user units^2]
  };

  /// A facet of a cluster: its corners' vertices of the surface, and its global element. Facets of a cluster follow
  /// each other. Returns its number.
  std::uint32_t add(const Mesh& mesh, std::uint32_t facet, const std::array<std::uint32_t, 3>& corners,
                    std::uint32_t element);
  /// Once all have been added.
  void finish(const Mesh& mesh);
  /// Adds to the areas of vertices of the surface those of the clusters that touch them.
  void add_areas(std::vector<double>& areas) const;

  std::uint64_t fits() const { return vertices_.size(); }  ///< of irradiance, one at each vertex
  const std::vector<Cluster>& clusters() const { return clusters_; }
  const std::vector<Facet>& facets() const { return facets_; }
  const std::vector<Vertex>& vertices() const { return vertices_; }
  std::span<const Near> near(const Vertex& vertex) const {
    return std::span(near_).subspan(vertex.first_near, vertex.near);
  }

 private:
  /// Of a vertex; until `finish`.
  struct Place {
    std::vector<std::uint32_t> touching;  ///< clusters
    Vec3d point{0, 0, 0};                 ///< normalised
  };

  void link();
  /// Appends to `near_` in time that grows with what it appends.
  void find_near(const Mesh& mesh, Vertex& vertex, const Place& place);
  /// Appends what counts within the reach [normalised]; false: it is more than `most`.
  bool take_near(const Vertex& vertex, const Place& place, double reach, std::size_t most);

  std::vector<Cluster> clusters_;
  std::vector<Facet> facets_;
  std::vector<Vertex> vertices_;
  std::vector<Near> near_;
  std::vector<Place> places_;                            ///< by vertex
  std::vector<std::vector<std::uint32_t>> vertices_of_;  ///< by cluster; until `finish`
  std::vector<std::vector<std::uint32_t>> beside_;       ///< by cluster: which meet it at a vertex; until `finish`
  std::vector<std::uint32_t> vertex_of_;                 ///< by vertex of the surface, or kNoSide; until `finish`
  std::vector<std::uint32_t> seen_;                      ///< clusters, by the search in progress
  std::vector<std::uint64_t> seen_in_;                   ///< by cluster: number of the last search that saw it
  std::uint64_t search_ = 0;
};

}  // namespace torolux
