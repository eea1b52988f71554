// SPDX-License-Identifier: MIT
// Regions grow from the largest triangle on, over edges.
#include "host_tools/mesh/flat_regions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host_tools/mesh/edges.hpp"
#include "host_tools/scene/flat_surfaces.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// Cosine between normals; small triangles lie near every plane through them.
constexpr double kSameNormal = 0.9999;
/// Periods: a fraction of the finest texture's texel.
constexpr double kSameTexel = 1e-4;

Vec3d cross_of(const Scene& scene, const SceneTriangle& t) {
  const Vec3d& a = scene.positions[t.position[0]];
  return vec::cross(vec::subtract(scene.positions[t.position[1]], a), vec::subtract(scene.positions[t.position[2]], a));
}

/// Triangle by triangle over edges that just two share, one each way.
std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_over_edges(const Scene& scene) {
  std::vector<std::array<std::uint32_t, 3>> corners;
  corners.reserve(scene.triangles.size());
  for (const SceneTriangle& t : scene.triangles) corners.push_back(t.position);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for_each_edge(edge_uses(corners), [&](std::span<const EdgeUse> uses) {
    if (uses.size() != 2 || uses[0].forward == uses[1].forward) return;
    pairs.emplace_back(uses[0].triangle, uses[1].triangle);
    pairs.emplace_back(uses[1].triangle, uses[0].triangle);
  });
  std::ranges::sort(pairs);
  return pairs;
}

bool repeats(const Scene& scene, const SceneTriangle& t) {
  const std::uint32_t texture = scene.materials[t.material].texture;
  return texture >= scene.textures.size() || !scene.textures[texture].clamped;
}

/// But for whole periods, by which texture points are moved so that they are small.
bool continues_texture(const Scene& scene, const SceneTriangle& t, const SceneTriangle& seed) {
  if ((t.texture_points == kNoImage) != (seed.texture_points == kNoImage)) return false;
  if (t.texture_points == kNoImage) return true;
  using Point = std::array<double, 2>;
  const Point* of_seed = &scene.texture_points[seed.texture_points];
  std::optional<Point> moved;
  for (std::uint32_t i = 0; i < 3; ++i) {
    const Point there = interpolated(weights_at(scene, seed, scene.positions[t.position[i]]),
                                     std::array<Point, 3>{of_seed[0], of_seed[1], of_seed[2]});
    const Point& own = scene.texture_points[t.texture_points + i];
    const Point by{there[0] - own[0], there[1] - own[1]};
    if (!moved) moved = repeats(scene, t) ? Point{std::round(by[0]), std::round(by[1])} : Point{0, 0};
    if (std::abs(by[0] - (*moved)[0]) > kSameTexel || std::abs(by[1] - (*moved)[1]) > kSameTexel) return false;
  }
  return true;
}

/// Moved by whole periods, so that they are small.
void add_texture_points(Scene& scene, std::uint32_t from, const std::array<std::array<double, 3>, 3>& weights,
                        SceneTriangle& part) {
  using Point = std::array<double, 2>;
  const std::array<Point, 3> whole{scene.texture_points[from], scene.texture_points[from + 1],
                                   scene.texture_points[from + 2]};
  part.texture_points = static_cast<std::uint32_t>(scene.texture_points.size());
  std::array<Point, 3> points{};
  for (std::size_t i = 0; i < 3; ++i) points[i] = interpolated(weights[i], whole);
  for (std::size_t axis = 0; axis < 2 && repeats(scene, part); ++axis) {
    const double periods = std::floor(std::min({points[0][axis], points[1][axis], points[2][axis]}) + 1e-9);
    for (Point& p : points) p[axis] -= periods;
  }
  scene.texture_points.insert(scene.texture_points.end(), points.begin(), points.end());
}

class RegionFinder {
 public:
  explicit RegionFinder(const Scene& scene) : scene_(scene), beside_(pairs_over_edges(scene)) {
    vec::Box box;
    for (const Vec3d& point : scene.positions) box.include(point);
    size_ = scene.positions.empty() ? 0 : vec::largest(box.extent());
  }

  FlatRegions find() {
    const auto count = static_cast<std::uint32_t>(scene_.triangles.size());
    std::vector<double> area(count);
    for (std::uint32_t t = 0; t < count; ++t) area[t] = vec::length(cross_of(scene_, scene_.triangles[t]));
    std::vector<std::uint32_t> largest_first(count);
    std::iota(largest_first.begin(), largest_first.end(), 0U);
    std::ranges::stable_sort(largest_first, [&](std::uint32_t a, std::uint32_t b) { return area[a] > area[b]; });
    FlatRegions found;
    taken_.assign(count, false);
    for (const std::uint32_t seed : largest_first)
      if (!taken_[seed]) found.all.push_back(grow(seed));
    std::ranges::sort(found.all, {}, [](const FlatRegion& region) { return region.triangles.front(); });
    found.region_of.resize(count);
    for (std::uint32_t r = 0; r < found.all.size(); ++r)
      for (const std::uint32_t t : found.all[r].triangles) found.region_of[t] = r;
    return found;
  }

 private:
  FlatRegion grow(std::uint32_t seed) {
    FlatRegion region{{seed}, seed};
    taken_[seed] = true;
    const SceneTriangle& first = scene_.triangles[seed];
    if (!is_plain(scene_, first)) return region;
    for (std::size_t next = 0; next < region.triangles.size(); ++next) {
      const auto at = std::pair(region.triangles[next], std::uint32_t{0});
      for (auto to = std::ranges::lower_bound(beside_, at); to != beside_.end() && to->first == at.first; ++to) {
        const std::uint32_t t = to->second;
        const SceneTriangle& beside = scene_.triangles[t];
        if (taken_[t] || !is_plain(scene_, beside) || !continues(scene_, beside, first, size_)) continue;
        taken_[t] = true;
        region.triangles.push_back(t);
      }
    }
    std::ranges::sort(region.triangles);
    return region;
  }

  const Scene& scene_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> beside_;
  double size_ = 0;
  std::vector<bool> taken_;
};

}  // namespace

std::array<double, 3> weights_at(const Scene& scene, const SceneTriangle& triangle, const Vec3d& point) {
  const Vec3d& a = scene.positions[triangle.position[0]];
  const Vec3d b = vec::subtract(scene.positions[triangle.position[1]], a);
  const Vec3d c = vec::subtract(scene.positions[triangle.position[2]], a);
  const Vec3d p = vec::subtract(point, a);
  const Vec3d normal = vec::cross(b, c);
  const double square = vec::dot(normal, normal);
  const double at_b = vec::dot(vec::cross(p, c), normal) / square;
  const double at_c = vec::dot(vec::cross(b, p), normal) / square;
  return {1 - at_b - at_c, at_b, at_c};
}

bool is_plain(const Scene& scene, const SceneTriangle& triangle) {
  const Vec3d cross = cross_of(scene, triangle);
  if (!(vec::length(cross) > 0)) return false;
  return triangle.normal[0] == kNoNormal || std::ranges::all_of(triangle.normal, [&](std::uint32_t n) {
           return vec::dot(scene.normals[n], vec::unit(cross)) > kSameNormal;
         });
}

bool continues(const Scene& scene, const SceneTriangle& triangle, const SceneTriangle& other, double size) {
  const Vec3d normal = vec::unit(cross_of(scene, other));
  if (triangle.material != other.material || !(vec::dot(vec::unit(cross_of(scene, triangle)), normal) > kSameNormal))
    return false;
  const Vec3d& origin = scene.positions[other.position[0]];
  const bool flat = std::ranges::all_of(triangle.position, [&](std::uint32_t p) {
    return std::abs(vec::dot(normal, vec::subtract(scene.positions[p], origin))) <= 0.5 * kSamePlane * size;
  });
  return flat && continues_texture(scene, triangle, other);
}

SceneTriangle part_of(Scene& scene, const SceneTriangle& triangle, const std::array<std::uint32_t, 3>& corners) {
  const SceneTriangle whole = triangle;  // it may be one of the scene's
  SceneTriangle part = whole;
  part.position = corners;
  std::array<std::array<double, 3>, 3> weights{};
  for (std::size_t i = 0; i < 3; ++i) weights[i] = weights_at(scene, whole, scene.positions[corners[i]]);
  part.normal.fill(kNoNormal);  // those of a plain triangle are its plane's
  if (whole.texture_points != kNoImage) add_texture_points(scene, whole.texture_points, weights, part);
  return part;
}

FlatRegions flat_regions(const Scene& scene) {
  return RegionFinder(scene).find();
}

}  // namespace torolux
