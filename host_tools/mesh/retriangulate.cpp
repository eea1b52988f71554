// SPDX-License-Identifier: MIT
// Region by region. Halving an edge of one asks its neighbours for the same point: they are cut again.
#include "host_tools/mesh/retriangulate.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <unordered_map>

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

  PlanePoint to_plane(const Vec3d& point) const {
    const Vec3d from = vec::subtract(point, origin_);
    const auto whole = [this](double x) {
      return static_cast<std::int32_t>(std::lround(std::clamp<double>(x / unit_, -kMostOfPlane, kMostOfPlane)));
    };
    return {whole(vec::dot(from, u_)), whole(vec::dot(from, v_))};
  }
  Vec3d to_space(PlanePoint point) const {
    return vec::add(origin_, vec::add(vec::scale(u_, point.x * unit_), vec::scale(v_, point.y * unit_)));
  }
  double in_units(double length) const { return length / unit_; }

 private:
  Vec3d origin_{}, u_{}, v_{};
  double unit_ = 1;
};

using Corners = std::array<std::uint32_t, 3>;  // positions

class Retriangulation {
 public:
  Retriangulation(Scene& scene, double least) : scene_(scene), least_(least), regions_(flat_regions(scene)) {}

  void run() {
    std::vector<bool> frozen(regions_.all.size(), false);
    const std::size_t positions = scene_.positions.size();
    for (;;) {
      scene_.positions.resize(positions);
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
    RegionBorders borders(scene_, regions_, frozen, least_);
    std::deque<std::uint32_t> waiting;
    std::vector<bool> waits(frozen.size(), false);
    const auto ask = [&](std::uint32_t region) {
      if (!waits[region]) waiting.push_back(region);
      waits[region] = true;
    };
    for (std::uint32_t region = 0; region < frozen.size(); ++region)
      if (!frozen[region] && (borders.has_needless_points(region) || is_thin(region))) ask(region);
    std::vector<std::uint32_t> failed;
    while (!waiting.empty()) {
      const std::uint32_t region = waiting.front();
      waiting.pop_front();
      waits[region] = false;
      std::vector<std::uint32_t> neighbours;
      cut_[region] = cut(region, borders, neighbours);
      if (!cut_[region]) failed.push_back(region);
      for (const std::uint32_t other : neighbours)
        if (other != region) ask(other);
    }
    std::ranges::sort(failed);
    return failed;
  }

  /// Some of its triangles as the file has them.
  bool is_thin(std::uint32_t region) const {
    if (least_ == kAnyLength) return false;
    const Plane plane(scene_, regions_.all[region]);
    return std::ranges::any_of(regions_.all[region].triangles, [&](std::uint32_t t) {
      const auto& p = scene_.triangles[t].position;
      return Triangulation::is_thin({plane.to_plane(scene_.positions[p[0]]), plane.to_plane(scene_.positions[p[1]]),
                                     plane.to_plane(scene_.positions[p[2]])},
                                    plane.in_units(least_));
    });
  }

  std::optional<std::vector<Corners>> cut(std::uint32_t region, RegionBorders& borders,
                                          std::vector<std::uint32_t>& neighbours) {
    const Plane plane(scene_, regions_.all[region]);
    std::vector<std::uint32_t> position;  // by point of the plane
    std::vector<PlanePoint> points;
    std::unordered_map<std::uint32_t, std::uint32_t> point_of;
    const auto point = [&](std::uint32_t p) {
      const auto [entry, fresh] = point_of.emplace(p, static_cast<std::uint32_t>(points.size()));
      if (fresh) {
        points.push_back(plane.to_plane(scene_.positions[p]));
        position.push_back(p);
      }
      return entry->second;
    };
    // In an order of their own, as it decides between diagonals of a rectangle.
    const auto edges = borders.around(region);
    std::vector<std::uint32_t> all;
    for (const auto& [a, b] : edges) all.insert(all.end(), {a, b});
    std::ranges::stable_sort(all, {}, [&](std::uint32_t p) { return scene_.positions[p]; });
    for (const std::uint32_t p : all) point(p);
    Triangulation::Border border;
    for (const auto& [a, b] : edges) border.emplace_back(point_of.at(a), point_of.at(b));
    auto triangulation = Triangulation::make(points, border);
    if (!triangulation) return std::nullopt;
    const std::size_t known = position.size();
    if (least_ != kAnyLength) {
      const auto halve = [&](std::uint32_t a, std::uint32_t b) -> std::optional<PlanePoint> {
        position.resize(triangulation->points().size(), kInside);
        const auto middle = halve_edge(position[a], position[b], borders, neighbours);
        if (!middle) return std::nullopt;
        position.push_back(*middle);
        return plane.to_plane(scene_.positions[*middle]);
      };
      if (!triangulation->refine(plane.in_units(least_), halve)) return std::nullopt;
      position.resize(triangulation->points().size(), kInside);
    }
    for (std::size_t p = known; p < position.size(); ++p) {
      if (position[p] != kInside) continue;
      position[p] = static_cast<std::uint32_t>(scene_.positions.size());
      scene_.positions.push_back(plane.to_space(triangulation->points()[p]));
    }
    std::vector<Corners> triangles;
    for (const auto& [a, b, c] : triangulation->triangles())
      triangles.push_back({position[a], position[b], position[c]});
    return triangles;
  }

  /// Its middle, a position: the same, whichever region asks. Absent: it stays whole.
  std::optional<std::uint32_t> halve_edge(std::uint32_t a, std::uint32_t b, RegionBorders& borders,
                                          std::vector<std::uint32_t>& neighbours) {
    if (!borders.may_halve(a, b)) return std::nullopt;
    for (const std::uint32_t region : borders.regions_at(a, b)) neighbours.push_back(region);
    const auto middle = static_cast<std::uint32_t>(scene_.positions.size());
    scene_.positions.push_back(vec::scale(vec::add(scene_.positions[a], scene_.positions[b]), 0.5));
    borders.halve(a, b, middle);
    return middle;
  }

  /// New ones stand where the first of their region stood.
  void replace_triangles() {
    std::vector<SceneTriangle> triangles;
    for (std::uint32_t t = 0; t < scene_.triangles.size(); ++t) {
      const std::uint32_t region = regions_.region_of[t];
      if (!cut_[region]) {
        triangles.push_back(scene_.triangles[t]);
      } else if (regions_.all[region].triangles.front() == t) {
        for (const Corners& corners : *cut_[region]) triangles.push_back(part_of(regions_.all[region], corners));
      }
    }
    scene_.triangles = std::move(triangles);
  }

  SceneTriangle part_of(const FlatRegion& region, const Corners& corners) {
    const SceneTriangle whole = scene_.triangles[region.seed];
    SceneTriangle part = whole;
    part.position = corners;
    std::array<std::array<double, 3>, 3> weights{};
    for (std::size_t i = 0; i < 3; ++i) weights[i] = weights_at(scene_, whole, scene_.positions[corners[i]]);
    if (whole.normal[0] != kNoNormal) {
      if (region.triangles.size() > 1) {
        part.normal.fill(kNoNormal);
      } else {
        for (std::size_t i = 0; i < 3; ++i) {
          part.normal[i] = static_cast<std::uint32_t>(scene_.normals.size());
          const std::array<Vec3d, 3> normals{scene_.normals[whole.normal[0]], scene_.normals[whole.normal[1]],
                                             scene_.normals[whole.normal[2]]};
          scene_.normals.push_back(vec::unit(interpolated(weights[i], normals)));
        }
      }
    }
    if (whole.texture_points != kNoImage) add_texture_points(whole.texture_points, weights, part);
    return part;
  }

  /// Moved by whole periods, so that they are small.
  void add_texture_points(std::uint32_t from, const std::array<std::array<double, 3>, 3>& weights,
                          SceneTriangle& part) {
    using Point = std::array<double, 2>;
    const std::array<Point, 3> whole{scene_.texture_points[from], scene_.texture_points[from + 1],
                                     scene_.texture_points[from + 2]};
    part.texture_points = static_cast<std::uint32_t>(scene_.texture_points.size());
    std::array<Point, 3> points{};
    for (std::size_t i = 0; i < 3; ++i) points[i] = interpolated(weights[i], whole);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double periods = std::floor(std::min({points[0][axis], points[1][axis], points[2][axis]}) + 1e-9);
      for (Point& p : points) p[axis] -= periods;
    }
    scene_.texture_points.insert(scene_.texture_points.end(), points.begin(), points.end());
  }

  static constexpr std::uint32_t kInside = 0xFFFF'FFFFU;  // a point that no other region sees
  Scene& scene_;
  double least_;
  FlatRegions regions_;
  std::vector<std::optional<std::vector<Corners>>> cut_;  // by region; absent: as it was
};

}  // namespace

void retriangulate(Scene& scene, double least) {
  if (scene.triangles.empty()) return;
  vec::Box box;
  for (const Vec3d& point : scene.positions) box.include(point);
  // A power of two: nothing is rounded.
  const int exponent = std::ilogb(vec::largest(box.extent()));
  for (Vec3d& point : scene.positions)
    for (double& x : point) x = std::ldexp(x, -exponent);
  Retriangulation(scene, least == kAnyLength ? least : std::ldexp(least, -exponent)).run();
  for (Vec3d& point : scene.positions)
    for (double& x : point) x = std::ldexp(x, exponent);
}

}  // namespace torolux
