// SPDX-License-Identifier: MIT
// Components wound alike, with no emitter inside, may be occluders; a point just over a surface is hidden where one
// fills half a sphere. Of an element half hidden, an open part shoots.
#include "host_tools/mesh/occlusion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "firmware/protocol/random.hpp"
#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/mesh/edges.hpp"
#include "host_tools/mesh/mesh.hpp"

namespace torolux {
namespace {

/// Points are looked at from so high over their triangle, as walls' feet are, in the space's longest edge.
constexpr double kHeight = 1e-5;
/// A occluder that leaves this much of half a sphere open, in steradians, has an opening: light may come in.
constexpr double kOpening = 1e-4;
/// Larger occluders hide nothing: to look from many points would take too long.
constexpr std::size_t kMostTriangles = 20'000;
/// A facet is looked at in 4^kParts parts.
constexpr std::uint32_t kParts = 2;

/// More than kHeight and rounding.
constexpr double kNear = 2 * kHeight;

bool overlap(const vec::Box& a, const vec::Box& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a.low[axis] > b.high[axis] + kNear || b.low[axis] > a.high[axis] + kNear) return false;
  }
  return true;
}

bool contains(const vec::Box& box, const Vec3d& point) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (point[axis] < box.low[axis] || point[axis] > box.high[axis]) return false;
  }
  return true;
}

std::array<Vec3d, 3> corners_of(const MeshTriangle& triangle) {
  return {to_double(triangle.corner[0]), to_double(triangle.corner[1]), to_double(triangle.corner[2])};
}

/// Triangles that hang together, by triangle.
struct Sets {
  std::vector<std::uint32_t> root;  ///< the lowest of the set
  std::vector<bool> alike;          ///< by root: wound alike, no edge is shared by more than two
  std::vector<std::pair<std::uint32_t, std::uint8_t>> border;  ///< triangle and edge, of edges that one triangle has
};

/// A set before it is known whether it may hide.
struct Candidate {
  std::vector<std::array<Vec3d, 3>> triangles;
  std::vector<std::array<Vec3d, 2>> border;
};

Sets sets_of(const Mesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> positions;
  for (const MeshTriangle& triangle : mesh.triangles) positions.push_back(triangle.position);
  const std::vector<EdgeUse> uses = edge_uses(positions);
  DisjointSets joined(positions.size());
  std::vector<bool> alike(positions.size(), true);
  std::vector<std::pair<std::uint32_t, std::uint8_t>> border;
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() == 1) border.emplace_back(edge[0].triangle, edge[0].edge);
    const bool one_way = edge.size() == 1 || (edge.size() == 2 && edge[0].forward != edge[1].forward);
    for (const EdgeUse& use : edge) {
      joined.merge(edge[0].triangle, use.triangle);
      if (!one_way) alike[use.triangle] = false;
    }
  });
  Sets sets{{}, std::vector<bool>(positions.size(), true), std::move(border)};
  for (std::uint32_t t = 0; t < positions.size(); ++t) {
    sets.root.push_back(joined.root(t));
    if (!alike[t]) sets.alike[sets.root[t]] = false;
  }
  return sets;
}

}  // namespace

PlanePoint middle_of_grid(std::uint32_t code) {
  const auto middle = protocol::middle_of_grid_triangle(protocol::path_of_code(code), protocol::level_of_code(code));
  constexpr double unit = 1.0 / (1U << protocol::kMostLevels);
  return {unit * (middle[1] / 3.0), unit * (middle[2] / 3.0)};
}

Occlusion::Occlusion(const Mesh& mesh, const Scene& scene) {
  Sets sets = sets_of(mesh);
  occluder_of_ = std::move(sets.root);
  std::vector<Candidate> all(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const SceneMaterial& material = scene.materials[mesh.triangles[t].material];
    Candidate& candidate = all[occluder_of_[t]];
    candidate.triangles.push_back(corners_of(mesh.triangles[t]));
    if (material.kind == SurfaceKind::glass || emits(material)) sets.alike[occluder_of_[t]] = false;
  }
  for (const auto& [triangle, edge] : sets.border) {
    const auto corner = corners_of(mesh.triangles[triangle]);
    all[occluder_of_[triangle]].border.push_back({corner[edge], corner[(edge + 1) % 3]});
  }
  std::vector<std::uint32_t> number(all.size(), protocol::kNoSide);
  for (std::size_t s = 0; s < all.size(); ++s) {
    const std::size_t size = all[s].triangles.size();
    if (size < 4 || size > kMostTriangles || !sets.alike[s]) continue;
    Occluder& occluder = occluders_.emplace_back();
    for (const auto& triangle : all[s].triangles)
      for (const Vec3d& corner : triangle) occluder.box.include(corner);
    occluder.angle = SolidAngle(std::move(all[s].triangles), all[s].border);
    number[s] = static_cast<std::uint32_t>(occluders_.size() - 1);
  }
  // Those that an emitter stands in are left out, and the numbers close ranks.
  const std::vector<bool> lit = lit_inside(mesh, scene);
  std::vector<std::uint32_t> kept(occluders_.size(), protocol::kNoSide);
  std::vector<Occluder> dark;
  for (std::size_t i = 0; i < occluders_.size(); ++i) {
    if (lit[i]) continue;
    kept[i] = static_cast<std::uint32_t>(dark.size());
    dark.push_back(std::move(occluders_[i]));
  }
  occluders_ = std::move(dark);
  for (std::uint32_t& occluder : occluder_of_) {
    occluder = number[occluder];
    if (occluder < kept.size()) occluder = kept[occluder];
  }
  find_near(mesh);
}

/// Triangles and occluders go along x in one order, so that only what may overlap there is looked at.
void Occlusion::find_near(const Mesh& mesh) {
  near_.assign(mesh.triangles.size(), {});
  if (occluders_.empty()) return;
  std::vector<std::uint32_t> order(occluders_.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {}, [&](std::uint32_t i) { return std::pair(occluders_[i].box.low[0], i); });
  // The greatest end of all up to here: where it lies before a triangle, so do all of them.
  std::vector<double> end;
  end.reserve(order.size());
  for (const std::uint32_t i : order)
    end.push_back(std::max(end.empty() ? -HUGE_VAL : end.back(), occluders_[i].box.high[0]));
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.triangles[t].sides == 0) continue;
    vec::Box box;
    for (const Vec3d& corner : corners_of(mesh.triangles[t])) box.include(corner);
    const auto first = std::ranges::lower_bound(end, box.low[0] - kNear) - end.begin();
    for (std::size_t i = static_cast<std::size_t>(first); i < order.size(); ++i) {
      const vec::Box& other = occluders_[order[i]].box;
      if (other.low[0] > box.high[0] + kNear) break;
      if (occluder_of_[t] != order[i] && overlap(box, other)) near_[t].push_back(order[i]);
    }
  }
}

std::vector<bool> Occlusion::lit_inside(const Mesh& mesh, const Scene& scene) const {
  std::vector<bool> lit(occluders_.size(), false);
  for (const MeshTriangle& triangle : mesh.triangles) {
    if (!emits(scene.materials[triangle.material])) continue;
    const auto corner = corners_of(triangle);
    const Vec3d middle = vec::scale(vec::add(vec::add(corner[0], corner[1]), corner[2]), 1.0 / 3);
    for (std::size_t i = 0; i < occluders_.size(); ++i) {
      if (lit[i] || !contains(occluders_[i].box, middle)) continue;
      // Half a sphere is enough for what stands on the floor: elsewhere, be careful.
      if (std::abs(occluders_[i].angle.seen_from(middle)) > std::numbers::pi) lit[i] = true;
    }
  }
  return lit;
}

bool Occlusion::occludes(const Mesh& mesh, std::uint32_t triangle, std::uint32_t side, const PlanePoint& point) const {
  if (occluders_.empty() || near_[triangle].empty()) return false;
  const auto corner = corners_of(mesh.triangles[triangle]);
  const Vec3d across = vec::subtract(corner[1], corner[0]);
  const Vec3d up = vec::subtract(corner[2], corner[0]);
  const Vec3d normal = vec::unit(vec::cross(across, up));
  Vec3d at = vec::add(corner[0], vec::add(vec::scale(across, point.b1), vec::scale(up, point.b2)));
  at = vec::add(at, vec::scale(normal, side == 0 ? kHeight : -kHeight));
  for (const std::uint32_t i : near_[triangle]) {
    if (occluders_[i].box.low[0] > at[0]) break;  // so do all that come after it
    if (!contains(occluders_[i].box, at)) continue;
    // What stands on the triangle fills half a sphere, whether it has a bottom of its own or not.
    if (std::abs(occluders_[i].angle.seen_from(at)) > 2 * std::numbers::pi - kOpening) return true;
  }
  return false;
}

bool is_hidden(const Mesh& mesh, std::uint32_t triangle, std::uint32_t code) {
  if (mesh.walls.touch(triangle, code)) return false;  // at its very foot, a wall fills more than it does beside it
  for (std::uint32_t side = 0; side < 2; ++side) {
    if ((mesh.triangles[triangle].sides & (1U << side)) == 0) continue;
    if (mesh.occlusion.occludes(mesh, triangle, side, middle_of_grid(code))) return true;
  }
  return false;
}

std::optional<std::uint32_t> sending_part(const Mesh& mesh, const MeshFacet& facet) {
  if (!mesh.walls.touch(facet.triangle, facet.code)) {
    // What came to a hidden part of an element came to its pieces that reach out beside the foot.
    if (facet.is_piece && is_hidden(mesh, facet.triangle, facet.code)) return std::nullopt;
    return facet.code;
  }
  const std::uint32_t most = std::min(kParts, protocol::kMostLevels - protocol::level_of_code(facet.code));
  const auto hidden = [&](std::uint32_t code) { return is_hidden(mesh, facet.triangle, code); };
  const auto parts = [&](std::uint32_t levels) {
    std::vector<std::uint32_t> codes;
    for (std::uint32_t path = 0; path < protocol::triangles_of_level(levels); ++path) {
      codes.push_back(facet.code << (2 * levels) | path);
    }
    return codes;
  };
  if (std::ranges::none_of(parts(most), hidden)) return facet.code;
  for (std::uint32_t levels = 0; levels <= most; ++levels) {
    std::vector<std::uint32_t> open = parts(levels);
    std::erase_if(open, [&](std::uint32_t code) { return mesh.walls.touch(facet.triangle, code) || hidden(code); });
    // Any of them, so that not all elements along a wall lean one way.
    if (!open.empty()) return open[protocol::hash_combine(facet.triangle, facet.code) % open.size()];
  }
  return std::nullopt;
}

}  // namespace torolux
