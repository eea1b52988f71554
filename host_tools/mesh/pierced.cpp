// SPDX-License-Identifier: MIT
// A plane sweeps along x; where it meets both an edge's way and a triangle, and their boxes meet, the two are looked
// at.
#include "host_tools/mesh/pierced.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

#include "host_tools/mesh/mesh.hpp"
#include "host_tools/scene/ray_triangle.hpp"

namespace torolux {
namespace {

/// Pairs of an edge and a triangle that are looked at one by one.
constexpr std::size_t kFewPairs = 4096;

/// Sine of an angle that is none.
constexpr double kFlat = 1e-6;

using Corners = std::array<Vec3d, 3>;

Corners corners_of(const MeshTriangle& triangle) {
  return {to_double(triangle.corner[0]), to_double(triangle.corner[1]), to_double(triangle.corner[2])};
}

Vec3d centre_of(const MeshTriangle& triangle) {
  const Corners corner = corners_of(triangle);
  return vec::scale(vec::add(vec::add(corner[0], corner[1]), corner[2]), 1.0 / 3);
}

bool meet(const vec::Box& a, const vec::Box& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a.low[axis] > b.high[axis] || b.low[axis] > a.high[axis]) return false;
  }
  return true;
}

bool crosses(const Vec3d& from, const Vec3d& to, const Corners& corner) {
  const Vec3d way = vec::subtract(to, from);
  const std::optional<PlaneHit> hit = meet_plane(from, way, corner);
  if (!hit || !hit->inside() || hit->t < 0 || hit->t > 1) return false;
  // In one plane, or flat: which of them lie on which side would be decided by rounding.
  const double edges =
      vec::length(vec::subtract(corner[1], corner[0])) * vec::length(vec::subtract(corner[2], corner[0]));
  return std::abs(hit->determinant) > kFlat * vec::length(way) * edges;
}

using Numbers = std::vector<std::uint32_t>;

Numbers all_of(std::size_t count) {
  Numbers numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0U);
  return numbers;
}

template <class Keep>
Numbers kept(const Numbers& numbers, const std::vector<vec::Box>& boxes, Keep keep) {
  Numbers result;
  std::ranges::copy_if(numbers, std::back_inserter(result), [&](std::uint32_t n) { return keep(boxes[n]); });
  return result;
}

/// Where space is halved.
struct Halving {
  std::size_t axis;
  double middle;
};

class Join {
 public:
  Join(const Mesh& mesh, std::span<const SmoothEdge> edges)
      : mesh_(mesh), edges_(edges), pierced_(mesh.triangles.size()) {
    triangles_.resize(mesh.triangles.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      for (const Vec3d& corner : corners_of(mesh.triangles[t])) triangles_[t].include(corner);
    }
    ways_.resize(edges.size());
    for (std::uint32_t e = 0; e < ways_.size(); ++e) {
      ways_[e].include(edges[e].middle);
      for (const std::uint32_t t : edges[e].triangle) ways_[e].include(centre_of(mesh.triangles[t]));
    }
  }

  std::vector<bool> find() {
    join(all_of(ways_.size()), all_of(triangles_.size()));
    return std::move(pierced_);
  }

 private:
  /// Looks at all of the two whose boxes meet.
  void join(const Numbers& ways, const Numbers& triangles) {
    if (ways.size() * triangles.size() <= kFewPairs) return look_at_all(ways, triangles);
    const Halving at = halving(ways);
    const auto below = [at](const vec::Box& box) { return box.low[at.axis] <= at.middle; };
    const auto above = [at](const vec::Box& box) { return box.high[at.axis] >= at.middle; };
    const std::array<Numbers, 2> way_halves{kept(ways, ways_, below), kept(ways, ways_, above)};
    const std::array<Numbers, 2> triangle_halves{kept(triangles, triangles_, below),
                                                 kept(triangles, triangles_, above)};
    std::size_t pairs = 0;
    for (std::size_t half = 0; half < 2; ++half) pairs += way_halves[half].size() * triangle_halves[half].size();
    // Where too much lies in one place, halves hold nearly all of it.
    if (4 * pairs > 3 * ways.size() * triangles.size()) return look_at_all(ways, triangles);
    for (std::size_t half = 0; half < 2; ++half) join(way_halves[half], triangle_halves[half]);
  }
  /// Across the longest extent, so that half of the ways' middles lie on each side: few large ones do not count.
  Halving halving(const Numbers& ways) const {
    vec::Box all;
    for (const std::uint32_t way : ways) all.include(ways_[way].centre());
    const Vec3d extent = all.extent();
    const auto axis = static_cast<std::size_t>(std::ranges::max_element(extent) - extent.begin());
    std::vector<double> middles;
    middles.reserve(ways.size());
    for (const std::uint32_t way : ways) middles.push_back(ways_[way].centre()[axis]);
    const auto half = middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2);
    std::ranges::nth_element(middles, half);
    return {axis, *half};
  }
  void look_at_all(const Numbers& ways, const Numbers& triangles) {
    for (const std::uint32_t way : ways) {
      for (const std::uint32_t triangle : triangles) {
        if (meet(ways_[way], triangles_[triangle])) look_at(way, triangle);
      }
    }
  }

  void look_at(std::uint32_t edge, std::uint32_t triangle) {
    if (touches(edge, triangle)) return;
    const Corners corner = corners_of(mesh_.triangles[triangle]);
    for (const std::uint32_t t : edges_[edge].triangle) {
      if (crosses(centre_of(mesh_.triangles[t]), edges_[edge].middle, corner)) pierced_[t] = true;
    }
  }

  bool touches(std::uint32_t edge, std::uint32_t triangle) const {
    const auto& corner = mesh_.triangles[triangle].position;
    return std::ranges::any_of(edges_[edge].triangle, [&](std::uint32_t t) {
      return std::ranges::find_first_of(mesh_.triangles[t].position, corner) != mesh_.triangles[t].position.end();
    });
  }

  const Mesh& mesh_;
  std::span<const SmoothEdge> edges_;
  std::vector<vec::Box> triangles_, ways_;
  std::vector<bool> pierced_;
};

}  // namespace

std::vector<bool> pierced_triangles(const Mesh& mesh, std::span<const SmoothEdge> edges) {
  return Join(mesh, edges).find();
}

}  // namespace torolux
