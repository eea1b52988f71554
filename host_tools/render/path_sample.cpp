// SPDX-License-Identifier: MIT
// See path_sample.hpp.
#include "host_tools/render/path_sample.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <utility>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

constexpr std::uint32_t kMostTurns = 8;
/// Diffuse surfaces on a path: what is left of the light after more is little.
constexpr std::uint32_t kReflections = 5;
/// Hits nearer than this are of the surface that the path leaves [scene lengths].
constexpr double kLeast = 1e-6;

struct Ray {
  Vec3d origin, direction;
};

struct Meeting {
  const MeshTriangle* triangle = nullptr;
  double t = HUGE_VAL;
  double b1 = 0, b2 = 0;
};

Vec3d corner_of(const MeshTriangle& triangle, std::size_t i) {
  return to_double(triangle.corner[i]);
}

Vec3d normal_of(const MeshTriangle& triangle) {
  const Vec3d a = vec::subtract(corner_of(triangle, 1), corner_of(triangle, 0));
  return vec::unit(vec::cross(a, vec::subtract(corner_of(triangle, 2), corner_of(triangle, 0))));
}

/// Moeller & Trumbore 1997.
void meet(const Ray& ray, const MeshTriangle& triangle, Meeting& nearest) {
  const Vec3d a = vec::subtract(corner_of(triangle, 1), corner_of(triangle, 0));
  const Vec3d b = vec::subtract(corner_of(triangle, 2), corner_of(triangle, 0));
  const Vec3d p = vec::cross(ray.direction, b);
  const double determinant = vec::dot(a, p);
  if (determinant == 0) return;
  const Vec3d s = vec::subtract(ray.origin, corner_of(triangle, 0));
  const double b1 = vec::dot(s, p) / determinant;
  const Vec3d q = vec::cross(s, a);
  const double b2 = vec::dot(ray.direction, q) / determinant;
  const double t = vec::dot(b, q) / determinant;
  if (b1 < 0 || b2 < 0 || b1 + b2 > 1 || t < kLeast || t >= nearest.t) return;
  nearest = {&triangle, t, b1, b2};
}

class Follower {
 public:
  Follower(const Scene& scene, const Mesh& mesh, const Placement& placement, PathSample& sample)
      : scene_(scene), mesh_(mesh), placement_(placement), sample_(sample) {}

  /// To the next diffuse surface: the point there and the surface's normal on that side. Nothing: it has left.
  std::optional<Ray> follow(Ray ray) {
    ++paths_;
    auto cell = placement_.grid.cell_of(to_float(ray.origin));
    for (std::uint32_t turns = 0; turns < kMostTurns; ++turns) {
      const Meeting met = walk(ray, cell);
      if (met.triangle == nullptr) {
        sample_.escaped += 1;
        return std::nullopt;
      }
      ray.origin = vec::add(ray.origin, vec::scale(ray.direction, met.t));
      const Vec3d n = normal_of(*met.triangle);
      const SurfaceKind kind = scene_.materials[met.triangle->material].kind;
      if (kind == SurfaceKind::diffuse) {
        const bool front = vec::dot(n, ray.direction) < 0;
        sample_.hits[static_cast<std::size_t>(met.triangle - mesh_.triangles.data())][front ? 0 : 1] += 1;
        deposit(met, cell);
        return Ray{ray.origin, front ? n : vec::scale(n, -1)};
      }
      work_at(cell).turns += 1;
      if (kind == SurfaceKind::mirror) {
        ray.direction = vec::subtract(ray.direction, vec::scale(n, 2 * vec::dot(n, ray.direction)));
      }
    }
    return std::nullopt;
  }

  /// From sums to means.
  void finish() {
    const double paths = std::max(1.0, paths_);
    for (PathWork& pe : sample_.of_pe) {
      for (double* value : {&pe.arrivals, &pe.visits, &pe.polygons, &pe.deposits, &pe.turns}) *value /= paths;
    }
    for (auto& sides : sample_.hits) {
      for (double& hits : sides) hits /= paths;
    }
    sample_.forwarded /= paths;
    sample_.escaped /= paths;
  }

 private:
  PathWork& work_at(const std::array<std::uint32_t, 3>& cell) {
    return sample_.of_pe[placement_.pe_of_cell[placement_.grid.index(cell)]];
  }

  /// From subspace to subspace until something is met; `cell` ends there.
  Meeting walk(const Ray& ray, std::array<std::uint32_t, 3>& cell) {
    const Grid& grid = placement_.grid;
    for (;;) {
      const auto& polygons = placement_.polygons_of_cell[grid.index(cell)];
      work_at(cell).visits += 1;
      work_at(cell).polygons += static_cast<double>(polygons.size());
      double out = HUGE_VAL;
      std::size_t axis = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        if (ray.direction[i] == 0) continue;
        const auto plane = static_cast<double>(grid.plane(i, cell[i] + (ray.direction[i] > 0 ? 1U : 0U)));
        const double t = (plane - ray.origin[i]) / ray.direction[i];
        if (t < out) {
          out = t;
          axis = i;
        }
      }
      Meeting nearest;
      for (const std::uint32_t number : polygons) meet(ray, mesh_.triangles[number], nearest);
      if (nearest.triangle != nullptr && nearest.t <= out + kLeast) return nearest;
      if (cell[axis] == (ray.direction[axis] > 0 ? grid.cells[axis] - 1 : 0)) return {};
      const protocol::PeNumber from = placement_.pe_of_cell[grid.index(cell)];
      cell[axis] += ray.direction[axis] > 0 ? 1U : ~0U;
      if (placement_.pe_of_cell[grid.index(cell)] != from) work_at(cell).arrivals += 1;
    }
  }

  void deposit(const Meeting& met, const std::array<std::uint32_t, 3>& cell) {
    protocol::Weights at{static_cast<float>(1 - met.b1 - met.b2), static_cast<float>(met.b1),
                         static_cast<float>(met.b2)};
    const std::uint32_t path = protocol::enter_level(at, met.triangle->patch_level);
    const protocol::PeNumber owner = placement_.patch_home[mesh_.parts[met.triangle->first_part + path].patch].pe;
    sample_.of_pe[owner].deposits += 1;
    if (owner == placement_.pe_of_cell[placement_.grid.index(cell)]) return;
    sample_.of_pe[owner].arrivals += 1;
    sample_.forwarded += 1;
  }

  const Scene& scene_;
  const Mesh& mesh_;
  const Placement& placement_;
  PathSample& sample_;
  double paths_ = 0;
};

class Chance {
 public:
  /// Not std::uniform_real_distribution: its numbers differ between libraries.
  double uniform() { return static_cast<double>(random_()) * 0x1p-32; }

  /// A uniform point on the unit sphere, added to the normal.
  Vec3d cosine_direction(const Vec3d& normal) {
    const double z = 2 * uniform() - 1;
    const double angle = 2 * std::numbers::pi * uniform();
    const double r = std::sqrt(1 - z * z);
    const Vec3d sum = vec::add(normal, {r * std::cos(angle), r * std::sin(angle), z});
    return vec::length(sum) > 1e-6 ? vec::unit(sum) : normal;
  }

 private:
  std::mt19937 random_{1};
};

/// Points on emitters, with equal chance for equal area, and their normals.
class Emitters {
 public:
  Emitters(const Scene& scene, const Mesh& mesh) {
    for (const MeshTriangle& triangle : mesh.triangles) {
      if (!emits(scene.materials[triangle.material])) continue;
      area_ += triangle.area;
      triangles_.push_back({area_, &triangle});
    }
  }

  bool empty() const { return triangles_.empty(); }

  Ray point(Chance& chance) const {
    const double at = chance.uniform() * area_;
    const auto found = std::upper_bound(triangles_.begin(), triangles_.end() - 1, at,
                                        [](double value, const auto& entry) { return value < entry.first; });
    const MeshTriangle& triangle = *found->second;
    double b1 = chance.uniform();
    double b2 = chance.uniform();
    if (b1 + b2 > 1) {
      b1 = 1 - b1;
      b2 = 1 - b2;
    }
    Vec3d point = corner_of(triangle, 0);
    point = vec::add(point, vec::scale(vec::subtract(corner_of(triangle, 1), corner_of(triangle, 0)), b1));
    point = vec::add(point, vec::scale(vec::subtract(corner_of(triangle, 2), corner_of(triangle, 0)), b2));
    return {point, normal_of(triangle)};
  }

 private:
  double area_ = 0;
  std::vector<std::pair<double, const MeshTriangle*>> triangles_;  ///< with the sum of areas up to and with this one
};

}  // namespace

PathWork PathSample::sum() const {
  PathWork all;
  for (const PathWork& pe : of_pe) {
    all.arrivals += pe.arrivals;
    all.visits += pe.visits;
    all.polygons += pe.polygons;
    all.deposits += pe.deposits;
    all.turns += pe.turns;
  }
  return all;
}

LightSample sample_light(const Scene& scene, const Mesh& mesh, const Placement& placement, std::uint32_t count) {
  LightSample light;
  for (PathSample* sample : {&light.emitted, &light.reflected}) {
    sample->of_pe.resize(placement.torus.pes());
    sample->hits.resize(mesh.triangles.size());
  }
  const Emitters emitters(scene, mesh);
  if (emitters.empty()) return light;
  Follower emitted(scene, mesh, placement, light.emitted);
  Follower reflected(scene, mesh, placement, light.reflected);
  Chance chance;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::optional<Ray> at = emitters.point(chance);
    for (std::uint32_t reflection = 0; at && reflection <= kReflections; ++reflection) {
      at = (reflection == 0 ? emitted : reflected).follow({at->origin, chance.cosine_direction(at->direction)});
    }
  }
  emitted.finish();
  reflected.finish();
  return light;
}

}  // namespace torolux
