// SPDX-License-Identifier: MIT
// Region by region. One that cannot be cut keeps its triangles, and its neighbours the points that they share with it.
#include "host_tools/mesh/retriangulate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "host_tools/mesh/corners_on_edges.hpp"
#include "host_tools/mesh/delaunay.hpp"
#include "host_tools/mesh/flat_regions.hpp"
#include "host_tools/mesh/region_borders.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// Coordinates in a region's plane, as whole numbers as fine as they can be.
class Plane {
 public:
  Plane(const Scene& scene, const FlatRegion& region) {
    const auto& corner = scene.triangles[region.seed].position;
    origin_ = scene.positions[corner[0]];
    const Vec3d across = vec::subtract(scene.positions[corner[1]], origin_);
    const Vec3d normal = vec::cross(across, vec::subtract(scene.positions[corner[2]], origin_));
    // Along the axis to which it is most nearly parallel: the same for whatever triangle is the seed.
    Vec3d axis{};
    axis[static_cast<std::size_t>(std::ranges::min_element(normal, {}, [](double x) { return std::abs(x); }) -
                                  normal.begin())] = 1;
    v_ = vec::unit(vec::cross(normal, axis));
    u_ = vec::unit(vec::cross(v_, normal));
    vec::Box box;
    for (const std::uint32_t t : region.triangles)
      for (const std::uint32_t p : scene.triangles[t].position) box.include(scene.positions[p]);
    origin_ = box.centre();
    unit_ = vec::length(box.extent()) * 0.51 / kMostOfPlane;
  }

  LatticePoint to_plane(const Vec3d& point) const {
    const Vec3d from = vec::subtract(point, origin_);
    const auto whole = [this](double x) {
      return static_cast<std::int32_t>(std::lround(std::clamp<double>(x / unit_, -kMostOfPlane, kMostOfPlane)));
    };
    return {whole(vec::dot(from, u_)), whole(vec::dot(from, v_))};
  }

 private:
  Vec3d origin_{}, u_{}, v_{};
  double unit_ = 1;
};

using Corners = std::array<std::uint32_t, 3>;  // positions

class Retriangulation {
 public:
  explicit Retriangulation(Scene& scene) : scene_(scene), regions_(flat_regions(scene)) {}

  void run() {
    std::vector<bool> frozen(regions_.all.size(), false);
    for (;;) {
      cut_.assign(regions_.all.size(), std::nullopt);
      const std::vector<std::uint32_t> failed = cut_all(frozen);
      if (failed.empty()) break;
      for (const std::uint32_t region : failed) frozen[region] = true;
    }
    replace_triangles();
  }

 private:
  /// Returns the regions that cannot be cut: outlines that cross themselves, or are finer than a plane's units.
  std::vector<std::uint32_t> cut_all(const std::vector<bool>& frozen) {
    const RegionBorders borders(scene_, regions_, frozen);
    std::vector<std::uint32_t> failed;
    for (std::uint32_t region = 0; region < frozen.size(); ++region) {
      if (frozen[region] || !borders.has_needless_points(region)) continue;
      cut_[region] = cut(region, borders);
      if (!cut_[region]) failed.push_back(region);
    }
    return failed;
  }

  std::optional<std::vector<Corners>> cut(std::uint32_t region, const RegionBorders& borders) const {
    const Plane plane(scene_, regions_.all[region]);
    const auto edges = borders.around(region);
    std::vector<std::uint32_t> positions;  // by point of the plane
    for (const auto& [a, b] : edges) positions.insert(positions.end(), {a, b});
    std::ranges::sort(positions);
    positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
    // In an order of their own, as it decides between diagonals of a rectangle.
    std::ranges::stable_sort(positions, {}, [&](std::uint32_t p) { return scene_.positions[p]; });
    std::vector<LatticePoint> points;
    std::unordered_map<std::uint32_t, std::uint32_t> point_of;
    for (const std::uint32_t p : positions) {
      point_of.emplace(p, static_cast<std::uint32_t>(points.size()));
      points.push_back(plane.to_plane(scene_.positions[p]));
    }
    Triangulation::Border border;
    for (const auto& [a, b] : edges) border.emplace_back(point_of.at(a), point_of.at(b));
    const auto triangulation = Triangulation::make(points, border);
    if (!triangulation) return std::nullopt;
    std::vector<Corners> triangles;
    for (const auto& [a, b, c] : triangulation->triangles())
      triangles.push_back({positions[a], positions[b], positions[c]});
    return triangles;
  }

  /// New ones stand where the first of their region stood.
  void replace_triangles() {
    std::vector<SceneTriangle> triangles;
    for (std::uint32_t t = 0; t < scene_.triangles.size(); ++t) {
      const std::uint32_t region = regions_.region_of[t];
      if (!cut_[region]) {
        triangles.push_back(scene_.triangles[t]);
      } else if (regions_.all[region].triangles.front() == t) {
        const SceneTriangle& whole = scene_.triangles[regions_.all[region].seed];
        for (const Corners& corners : *cut_[region]) triangles.push_back(part_of(scene_, whole, corners));
      }
    }
    scene_.triangles = std::move(triangles);
  }

  Scene& scene_;
  FlatRegions regions_;
  std::vector<std::optional<std::vector<Corners>>> cut_;  // by region; absent: as it was
};

}  // namespace

void retriangulate(Scene& scene) {
  if (scene.triangles.empty()) return;
  vec::Box box;
  for (const Vec3d& point : scene.positions) box.include(point);
  // A power of two: nothing is rounded.
  const int exponent = std::ilogb(vec::largest(box.extent()));
  for (Vec3d& point : scene.positions)
    for (double& x : point) x = std::ldexp(x, -exponent);
  split_edges_at_corners(scene);
  Retriangulation(scene).run();
  for (Vec3d& point : scene.positions)
    for (double& x : point) x = std::ldexp(x, exponent);
}

}  // namespace torolux
