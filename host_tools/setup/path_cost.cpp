// SPDX-License-Identifier: MIT
// A ray steps from cell to cell as on the PEs. Boxes and polygons that are tested, hand-overs and deposits count for
// the PE that does them; the steps go to the heat, where one is given.
#include "host_tools/setup/path_cost.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/scene/ray_triangle.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// Hits nearer than this are of the surface that the path leaves [scene lengths].
constexpr double kLeast = 1e-6;

Vec3d corner_of(const MeshTriangle& triangle, std::size_t i) {
  return to_double(triangle.corner[i]);
}

void meet(const SampleRay& ray, const MeshTriangle& triangle, Meeting& nearest) {
  const auto hit =
      meet_plane(ray.origin, ray.direction, {corner_of(triangle, 0), corner_of(triangle, 1), corner_of(triangle, 2)});
  if (!hit || !hit->inside() || hit->t < kLeast || hit->t >= nearest.t) return;
  nearest = {&triangle, hit->t, hit->b1, hit->b2};
}

/// A box as protocol::boxes_apart wants it of a ray.
std::uint32_t as_of_ray(protocol::PackedBox box) {
  std::uint32_t packed = protocol::kBoxRayFlips;
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t parts = protocol::highest_part(box, axis) | protocol::lowest_part(box, axis)
                                                                        << protocol::kBoxUpperShift;
    packed ^= parts << (protocol::kBoxAxisShift * axis);
  }
  return packed;
}

}  // namespace

PathWork& PathWork::operator+=(const PathWork& other) {
  starts += other.starts;
  hand_overs += other.hand_overs;
  steps += other.steps;
  visits += other.visits;
  boxes += other.boxes;
  tests += other.tests;
  deposits += other.deposits;
  sent_light += other.sent_light;
  turns += other.turns;
  aims += other.aims;
  return *this;
}

PathWork& PathWork::operator*=(double factor) {
  for (double* value : {&starts, &hand_overs, &steps, &visits, &boxes, &tests, &deposits, &sent_light, &turns, &aims}) {
    *value *= factor;
  }
  return *this;
}

PathWork PathSample::sum() const {
  PathWork all = anywhere;
  for (const PathWork& pe : of_pe) all += pe;
  return all;
}

namespace {

/// base^exponent for a base above 0 and up to 1, exponent 0 to 1: to some 12 digits, and by operations that every
/// computer rounds alike, as a placement may depend on it.
double power(double base, double exponent) {
  int two = 0;
  const double part = std::frexp(base, &two);  // 0.5 to 1
  const double z = (part - 1) / (part + 1);
  double logarithm = 0;
  for (int i = 25; i > 0; i -= 2) logarithm = logarithm * z * z + 2.0 / i;
  const double halvings = exponent * (two + logarithm * z / std::numbers::ln2);
  const double whole = std::floor(halvings);
  const double rest = (halvings - whole) * std::numbers::ln2;
  double sum = 1;
  for (int i = 18; i > 0; --i) sum = 1 + sum * rest / i;
  return std::ldexp(sum, static_cast<int>(whole));
}

}  // namespace

Vec3d normal_of(const MeshTriangle& triangle) {
  const Vec3d a = vec::subtract(corner_of(triangle, 1), corner_of(triangle, 0));
  return vec::unit(vec::cross(a, vec::subtract(corner_of(triangle, 2), corner_of(triangle, 0))));
}

Vec3d mirrored(const Vec3d& direction, const Vec3d& normal) {
  return vec::subtract(direction, vec::scale(normal, 2 * vec::dot(normal, direction)));
}

/// Marsaglia 1972.
Vec3d Chance::sphere_direction() {
  for (;;) {
    const double a = 2 * uniform() - 1;
    const double b = 2 * uniform() - 1;
    const double square = a * a + b * b;
    if (square >= 1) continue;
    const double r = 2 * std::sqrt(1 - square);
    return {r * a, r * b, 1 - 2 * square};
  }
}

/// A uniform point on the unit sphere, added to the normal.
Vec3d Chance::cosine_direction(const Vec3d& normal) {
  const Vec3d sum = vec::add(normal, sphere_direction());
  return vec::length(sum) > 1e-6 ? vec::unit(sum) : normal;
}

Vec3d Chance::lobe_direction(const Vec3d& axis, double exponent) {
  const double cosine = power(1 - uniform(), 1 / (exponent + 1));
  const Vec3d any = sphere_direction();
  const Vec3d aside = vec::subtract(any, vec::scale(axis, vec::dot(any, axis)));
  if (!(vec::length(aside) > 1e-6)) return axis;
  return vec::add(vec::scale(axis, cosine), vec::scale(vec::unit(aside), std::sqrt(1 - cosine * cosine)));
}

EmitterPoints::EmitterPoints(const Scene& scene, const Mesh& mesh) {
  for (const MeshTriangle& triangle : mesh.triangles) {
    const SceneMaterial& material = scene.materials[triangle.material];
    if (!emits(material)) continue;
    flux_ += triangle.area * (material.emission[0] + material.emission[1] + material.emission[2]);
    triangles_.push_back({flux_, &triangle});
  }
}

EmitterPoints::Point EmitterPoints::point(Chance& chance) const {
  const double at = chance.uniform() * flux_;
  const auto found = std::upper_bound(triangles_.begin(), triangles_.end() - 1, at,
                                      [](double value, const auto& entry) { return value < entry.first; });
  const MeshTriangle& triangle = *found->second;
  double b1 = chance.uniform();
  double b2 = chance.uniform();
  if (b1 + b2 > 1) {
    b1 = 1 - b1;
    b2 = 1 - b2;
  }
  Vec3d place = corner_of(triangle, 0);
  place = vec::add(place, vec::scale(vec::subtract(corner_of(triangle, 1), corner_of(triangle, 0)), b1));
  place = vec::add(place, vec::scale(vec::subtract(corner_of(triangle, 2), corner_of(triangle, 0)), b2));
  return {&triangle, place};
}

PathCost::PathCost(const Mesh& mesh, const Placement& placement, PathSample& sample, Heat* heat)
    : mesh_(mesh), placement_(placement), sample_(sample), heat_(heat) {
  sample_.of_pe.resize(placement.torus.pes());
  sample_.hits.resize(mesh.triangles.size());
}

void PathCost::begin(double records, const Cell& cell) {
  records_ = static_cast<float>(records);
  first_ = true;
  at_.reset();
  if (placement_.scheme == Scheme::paper || placement_.torus.pes() == 1) {
    at_ = placement_.pe_of_cell[placement_.grid.index(cell)];
  }
}

double PathCost::elsewhere() const {
  return at_ ? 1 : 1 - 1.0 / placement_.torus.pes();
}

/// The record is handed over where the subspace is not held.
void PathCost::enter(CellIndex cell) {
  if (!placement_.stop_cell[cell] || placement_.common_cell[cell]) return;
  const protocol::PeNumber pe = placement_.pe_of_cell[cell];
  if (at_ == pe) return;
  sample_.of_pe[pe].hand_overs += elsewhere();
  at_ = pe;
}

void PathCost::add_to_heat(CellIndex cell) {
  if (heat_ == nullptr) return;
  if (!placement_.stop_cell[cell]) return;
  heat_->steps.push_back({cell, records_, first_});
  first_ = false;
}

PathCost::Cell PathCost::cell_of(const Vec3d& point) const {
  return placement_.grid.cell_of(to_float(point));
}

/// What find_nearest of firmware/pe/traverse.cpp does. from, to: where the ray enters and leaves.
void PathCost::look_into(const SampleRay& ray, CellIndex index, const Cell& cell, double from, double to) {
  const auto& entries = placement_.entries_of_cell[index];
  if (entries.empty()) return;
  const protocol::Vec3f begin = to_float(vec::add(ray.origin, vec::scale(ray.direction, from)));
  const protocol::Vec3f end = to_float(vec::add(ray.origin, vec::scale(ray.direction, to)));
  const std::uint32_t box = as_of_ray(
      protocol::box_in_cell(std::array<protocol::Vec3f, 3>{begin, end, end}, placement_.grid.cell_size, cell));
  PathWork& here = work();
  here.visits += 1;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    here.boxes += 1;
    const bool apart = protocol::boxes_apart(box, entries[i].box);
    if ((entries[i].polygon & protocol::kGroup) == 0) {
      here.tests += apart ? 0 : 1;
    } else if (apart) {
      i += entries[i].polygon & ~protocol::kGroup;
    }
  }
}

Meeting PathCost::walk(const SampleRay& ray, Cell& cell) {
  const Grid& grid = placement_.grid;
  double entered = 0;
  enter(grid.index(cell));
  work().starts += 1;
  for (;;) {
    const CellIndex index = grid.index(cell);
    add_to_heat(index);
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
    look_into(ray, index, cell, entered, out);
    Meeting nearest;
    for (const std::uint32_t number : placement_.polygons_of_cell[index]) meet(ray, mesh_.triangles[number], nearest);
    if (nearest.triangle != nullptr && nearest.t <= out + kLeast) return nearest;
    if (cell[axis] == (ray.direction[axis] > 0 ? grid.cells[axis] - 1 : 0)) return {};
    cell[axis] += ray.direction[axis] > 0 ? 1U : ~0U;
    entered = out;
    work().steps += 1;
    enter(grid.index(cell));
  }
}

namespace {

/// Into Mesh::parts.
std::uint32_t part_at(const Meeting& met) {
  protocol::Weights weights{static_cast<float>(1 - met.b1 - met.b2), static_cast<float>(met.b1),
                            static_cast<float>(met.b2)};
  return met.triangle->first_part + protocol::enter_level(weights, met.triangle->patch_level);
}

}  // namespace

void PathCost::see(const Meeting& met) {
  work().deposits += 1;
  if (met.triangle->sides == 0) return;
  const std::uint32_t part = part_at(met);
  if (heat_ != nullptr) heat_->surfaces[part] += static_cast<double>(records_);
  if (!placement_.has_keeper(part) || at_ == placement_.keeper_of_part[part]) return;
  at_ = placement_.keeper_of_part[part];
  work().hand_overs += 1;
}

std::uint32_t PathCost::deposit(const Meeting& met) {
  const std::uint32_t patch = mesh_.parts[part_at(met)].patch;
  const protocol::PeNumber owner = placement_.patch_home[patch].pe;
  work().deposits += 1;
  if (at_ != owner) sample_.of_pe[owner].sent_light += elsewhere();
  if (heat_ != nullptr) heat_->deposits[patch] += static_cast<double>(records_) * kHeatPerDeposit;
  return patch;
}

}  // namespace torolux
