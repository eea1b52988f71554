// SPDX-License-Identifier: MIT
// Grows flat surfaces over shared edges; sorts them by plane to find those that may overlap.
#include "host_tools/scene/flat_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "host_tools/scene/components.hpp"

namespace torolux {
namespace {

/// Of pairs whose planes are near to each other's: some seconds.
constexpr std::size_t kMostTests = 50'000'000;

struct Edge {
  std::uint32_t low, high, triangle;
  bool upwards;
};

std::array<Vec3d, 3> corners_of(const Scene& scene, std::uint32_t t) {
  const auto& p = scene.triangles[t].position;
  return {scene.positions[p[0]], scene.positions[p[1]], scene.positions[p[2]]};
}

Vec3d cross_of(const std::array<Vec3d, 3>& c) {
  return vec::cross(vec::subtract(c[1], c[0]), vec::subtract(c[2], c[0]));
}

/// Triangles on the other side of each edge, run through the other way, in the same material.
std::vector<std::pair<std::uint32_t, std::uint32_t>> neighbours(const Scene& scene) {
  std::vector<Edge> edges;
  edges.reserve(3 * scene.triangles.size());
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = scene.triangles[t].position[i];
      const std::uint32_t b = scene.triangles[t].position[(i + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  }
  std::ranges::sort(edges, [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.triangle, a.upwards) < std::tie(b.low, b.high, b.triangle, b.upwards);
  });
  constexpr std::size_t most_on_an_edge = 16;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].low == edges[begin].low && edges[end].high == edges[begin].high) ++end;
    if (end - begin > most_on_an_edge) continue;
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t k = begin; k < end; ++k)
        if (edges[i].upwards != edges[k].upwards &&
            scene.triangles[edges[i].triangle].material == scene.triangles[edges[k].triangle].material)
          found.emplace_back(edges[i].triangle, edges[k].triangle);
  }
  std::ranges::sort(found);
  return found;
}

std::vector<bool> in_solids(const Scene& scene, double size) {
  std::vector<bool> solid(scene.triangles.size(), false);
  for (const Component& component : components(scene)) {
    if (!component.closed || !(component.volume > 1e-9 * size * size * size)) continue;
    for (const std::uint32_t t : component.triangles) solid[t] = true;
  }
  return solid;
}

/// Whole numbers. As doubles: a small scene far from the origin is more steps away than an integer counts.
using Cell = std::array<double, 4>;

/// A plane's normal and distance in steps, its signs chosen so that both ways round are one. Surfaces near the border
/// between two steps are in both.
std::vector<Cell> cells_of(const FlatSurface& surface, const Vec3d& point, double size) {
  constexpr double step = 1.0 / 512;
  constexpr double near = 0.1;
  std::size_t largest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis)
    if (std::abs(surface.normal[axis]) > std::abs(surface.normal[largest]) + 1e-3) largest = axis;
  const Vec3d normal = vec::scale(surface.normal, surface.normal[largest] < 0 ? -1 : 1);
  const std::array<double, 4> value{normal[0] / step, normal[1] / step, normal[2] / step,
                                    vec::dot(normal, point) / size / step};
  std::vector<Cell> cells{{}};
  for (std::size_t i = 0; i < 4; ++i) {
    const double below = std::floor(value[i] + 0.5);
    const double rest = value[i] + 0.5 - below;
    const int beside = rest < near ? -1 : rest > 1 - near ? 1 : 0;
    const std::size_t count = cells.size();
    for (std::size_t k = 0; k < count; ++k) {
      cells[k][i] = below;
      if (beside == 0) continue;
      cells.push_back(cells[k]);
      cells.back()[i] += beside;
    }
  }
  return cells;
}

bool in_one_plane(const Scene& scene, const FlatSurface& a, const FlatSurface& b, double size) {
  const FlatSurface& large = a.area >= b.area ? a : b;
  const FlatSurface& small = a.area >= b.area ? b : a;
  const Vec3d& on = scene.positions[scene.triangles[large.triangles[0]].position[0]];
  return std::ranges::all_of(small.triangles, [&](std::uint32_t t) {
    return std::ranges::all_of(corners_of(scene, t), [&](const Vec3d& corner) {
      return std::abs(vec::dot(large.normal, vec::subtract(corner, on))) <= kSamePlane * size;
    });
  });
}

/// Touching counts as apart.
bool boxes_overlap(const vec::Box& a, const vec::Box& b, double size) {
  int wide = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double common = std::min(a.high[axis], b.high[axis]) - std::max(a.low[axis], b.low[axis]);
    if (common < -kSamePlane * size) return false;
    if (common > kSamePlane * size) ++wide;
  }
  return wide >= 2;
}

bool stands_on(const FlatSurface& a, const FlatSurface& b) {
  return (a.solid || b.solid) && vec::dot(a.normal, b.normal) < 0;
}

}  // namespace

std::vector<FlatSurface> flat_surfaces(const Scene& scene, double size) {
  const auto beside = neighbours(scene);
  const std::vector<bool> solid = in_solids(scene, size);
  std::vector<bool> taken(scene.triangles.size(), false);
  std::vector<FlatSurface> found;
  for (std::uint32_t first = 0; first < scene.triangles.size(); ++first) {
    if (taken[first]) continue;
    FlatSurface& surface = found.emplace_back();
    const auto corner = corners_of(scene, first);
    surface.normal = vec::unit(vec::scale(cross_of(corner), 1 / (size * size)));
    const SceneMaterial& material = scene.materials[scene.triangles[first].material];
    surface.emits = emits(material);
    surface.glass = material.kind == SurfaceKind::glass;
    surface.solid = solid[first];
    surface.triangles.push_back(first);
    taken[first] = true;
    for (std::size_t next = 0; next < surface.triangles.size(); ++next) {
      const std::uint32_t t = surface.triangles[next];
      const auto own = corners_of(scene, t);
      surface.area += 0.5 * vec::length(cross_of(own));
      for (const Vec3d& point : own) surface.box.include(point);
      for (auto to = std::ranges::lower_bound(beside, std::pair(t, std::uint32_t{0}));
           to != beside.end() && to->first == t; ++to) {
        const auto other = corners_of(scene, to->second);
        const bool flat = std::ranges::all_of(other, [&](const Vec3d& point) {
          return std::abs(vec::dot(surface.normal, vec::subtract(point, corner[0]))) <= 0.5 * kSamePlane * size;
        });
        if (taken[to->second] || !flat || !(vec::dot(cross_of(other), surface.normal) > 0)) continue;
        taken[to->second] = true;
        surface.triangles.push_back(to->second);
      }
    }
    std::ranges::sort(surface.triangles);
  }
  return found;
}

bool lies_on(const std::vector<FlatSurface>& surfaces, std::uint32_t upper, std::uint32_t lower) {
  const FlatSurface& a = surfaces[upper];
  const FlatSurface& b = surfaces[lower];
  if (a.emits != b.emits) return a.emits;
  if (std::abs(a.area - b.area) > 1e-6 * (a.area + b.area)) return a.area < b.area;
  return upper < lower;
}

PlanePairs pairs_in_one_plane(const Scene& scene, const std::vector<FlatSurface>& surfaces, double size) {
  std::vector<std::pair<Cell, std::uint32_t>> entries;
  for (std::uint32_t s = 0; s < surfaces.size(); ++s) {
    const Vec3d& point = scene.positions[scene.triangles[surfaces[s].triangles[0]].position[0]];
    for (const auto& cell : cells_of(surfaces[s], point, size)) entries.emplace_back(cell, s);
  }
  std::size_t axis = 0;
  vec::Box all;
  for (const FlatSurface& surface : surfaces) {
    all.include(surface.box.low);
    all.include(surface.box.high);
  }
  for (std::size_t i = 1; i < 3; ++i)
    if (all.extent()[i] > all.extent()[axis]) axis = i;
  std::ranges::sort(entries, [&](const auto& a, const auto& b) {
    return std::tie(a.first, surfaces[a.second].box.low[axis], a.second) <
           std::tie(b.first, surfaces[b.second].box.low[axis], b.second);
  });
  PlanePairs result;
  auto& found = result.pairs;
  std::size_t tests_left = kMostTests;
  for (std::size_t i = 0; i < entries.size() && !result.too_many; ++i) {
    const FlatSurface& a = surfaces[entries[i].second];
    for (std::size_t k = i + 1; k < entries.size() && entries[k].first == entries[i].first &&
                                surfaces[entries[k].second].box.low[axis] <= a.box.high[axis];
         ++k) {
      if (tests_left-- == 0) {
        result.too_many = true;
        break;
      }
      const FlatSurface& b = surfaces[entries[k].second];
      if (a.glass != b.glass || !boxes_overlap(a.box, b.box, size) || stands_on(a, b) ||
          !in_one_plane(scene, a, b, size))
        continue;
      const bool first_on_top = lies_on(surfaces, entries[i].second, entries[k].second);
      found.emplace_back(entries[first_on_top ? i : k].second, entries[first_on_top ? k : i].second);
    }
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return result;
}

}  // namespace torolux
