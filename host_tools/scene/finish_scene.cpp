// SPDX-License-Identifier: MIT
// The last step of building: what does not count is left out, what is equal is merged, numbers close ranks.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>

#include "host_tools/scene/build_scene.hpp"
#include "host_tools/scene/keep_on.hpp"
#include "host_tools/scene/sky.hpp"

namespace torolux {
namespace {

/// For each position the number of the first one at the same place. Programs reckon the two sides of a seam apart, and
/// write all digits of what should be equal: what lies in one cell of two grids, of 2^-40 of the scene's longest edge
/// and half a cell apart, is one.
std::vector<std::uint32_t> first_equal(const std::vector<Vec3d>& positions, const vec::Box& box, double longest) {
  std::vector<std::uint32_t> first(positions.size());
  std::iota(first.begin(), first.end(), std::uint32_t{0});
  const auto root = [&first](std::uint32_t p) {
    while (first[p] != p) p = first[p] = first[first[p]];
    return p;
  };
  std::vector<std::uint32_t> order = first;
  std::vector<std::array<std::int64_t, 3>> cells(positions.size());
  for (const double shift : {0.0, 0.5}) {
    for (std::size_t p = 0; p < positions.size(); ++p) {
      const Vec3d scaled = vec::scale(vec::subtract(positions[p], box.low), 0x1p40 / longest);
      for (std::size_t axis = 0; axis < 3; ++axis) cells[p][axis] = std::llround(scaled[axis] + shift);
    }
    std::sort(order.begin(), order.end(),
              [&cells](std::uint32_t a, std::uint32_t b) { return std::tie(cells[a], a) < std::tie(cells[b], b); });
    for (std::size_t i = 1; i < order.size(); ++i) {
      if (cells[order[i]] != cells[order[i - 1]]) continue;
      const auto [low, high] = std::minmax({root(order[i]), root(order[i - 1])});
      first[high] = low;
    }
  }
  for (std::uint32_t p = 0; p < positions.size(); ++p) first[p] = root(p);
  return first;
}

/// As the PEs will hold it: scaled to the unit cube and rounded to float.
Vec3d as_float(const Vec3d& p, const vec::Box& box, double longest) {
  Vec3d rounded{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    rounded[axis] = static_cast<double>(static_cast<float>((p[axis] - box.low[axis]) / longest));
  return rounded;
}

bool has_area(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d normal = vec::cross(vec::subtract(b, a), vec::subtract(c, a));
  // In floats a PE could make nothing of less: its unit normal would come from a product that underflows.
  return vec::dot(normal, normal) > 1e-30;
}

/// Whatever its size.
bool is_no_line(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d ab = vec::subtract(b, a);
  const Vec3d ac = vec::subtract(c, a);
  return vec::length(vec::cross(ab, ac)) > 1e-6 * vec::length(ab) * vec::length(ac);
}

/// Corners turned so that the lowest number comes first: equal for equal triangles of equal winding.
std::array<std::uint32_t, 3> canonical(std::array<std::uint32_t, 3> corners) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// true at each triangle that equals one before it.
std::vector<bool> repeated(const std::vector<SceneTriangle>& triangles) {
  std::vector<std::uint32_t> order(triangles.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  const auto key = [&triangles](std::uint32_t i) { return canonical(triangles[i].position); };
  std::sort(order.begin(), order.end(),
            [&key](std::uint32_t a, std::uint32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  std::vector<bool> again(triangles.size(), false);
  for (std::size_t i = 1; i < order.size(); ++i) again[order[i]] = key(order[i]) == key(order[i - 1]);
  return again;
}

/// Gives numbers in the order of first use and collects what was used.
template <typename T>
class Renumber {
 public:
  explicit Renumber(const std::vector<T>& from) : from_(from), number_(from.size(), kUnused) {}
  std::uint32_t operator()(std::uint32_t old) {
    if (number_[old] == kUnused) {
      number_[old] = static_cast<std::uint32_t>(used_.size());
      used_.push_back(from_[old]);
    }
    return number_[old];
  }
  std::vector<T> take() { return std::move(used_); }

 private:
  static constexpr std::uint32_t kUnused = 0xFFFF'FFFFU;
  const std::vector<T>& from_;
  std::vector<std::uint32_t> number_;
  std::vector<T> used_;
};

/// Corner normals are kept where they tell something that the flat triangle does not, and agree with its front.
bool normals_usable(const std::array<Vec3d, 3>& normals, const Vec3d& flat) {
  return std::all_of(normals.begin(), normals.end(), [&flat](const Vec3d& n) {
    const double length = vec::length(n);
    return length > 1e-100 && length < 1e100 && vec::dot(vec::scale(n, 1.0 / length), flat) > 1e-3;
  });
}

}  // namespace

bool SceneBuilder::has_surface() const {
  if (triangles_.empty()) return false;
  const vec::Box box = bounds();
  const double longest = vec::largest(box.extent());
  return longest > 1e-30 && std::ranges::any_of(triangles_, [&](const SceneTriangle& triangle) {
           const auto corner = [&](std::size_t i) { return as_float(positions_[triangle.position[i]], box, longest); };
           return has_area(corner(0), corner(1), corner(2));
         });
}

void SceneBuilder::finish(Scene& scene, const Place& place) {
  if (!has_surface()) {
    std::string why = "no surface with an area: there is nothing to render";
    for (const std::string& line : notices_.lines()) why += "\n  " + line;
    refuse(place, why);
  }
  vec::Box box = bounds();
  include_openings(scene, box);
  const double longest = vec::largest(box.extent());
  const std::vector<std::uint32_t> first = first_equal(positions_, box, longest);
  for (SceneTriangle& triangle : triangles_)
    for (std::uint32_t& p : triangle.position) p = first[p];
  look_for_interruption();
  const std::vector<bool> again = repeated(triangles_);

  Renumber<Vec3d> positions(positions_);
  Renumber<Vec3d> normals(normals_);
  Renumber<SceneMaterial> materials(materials_);
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    look_for_interruption(i);
    SceneTriangle triangle = triangles_[i];
    const Place origin{files_[origins_[i].file], origins_[i].line};
    const Vec3d& a = positions_[triangle.position[0]];
    const Vec3d& b = positions_[triangle.position[1]];
    const Vec3d& c = positions_[triangle.position[2]];
    if (!has_area(as_float(a, box, longest), as_float(b, box, longest), as_float(c, box, longest))) {
      if (const SceneMaterial& lost = materials_[triangle.material]; emits(lost) && is_no_line(a, b, c))
        notices_.note("a triangle that emits is left out: against the scene it is too small for single precision",
                      origin, "'" + lost.name + "'");
      else
        notices_.note("a triangle without area is left out", origin);
      continue;
    }
    if (again[i]) {
      notices_.note("an exact duplicate of an earlier triangle is left out", origin);
      continue;
    }
    const SceneMaterial& material = materials_[triangle.material];
    const bool wanted = material.kind != SurfaceKind::diffuse || is_glossy(material);
    if (triangle.normal[0] != kNoNormal) {
      const std::array<Vec3d, 3> corner{normals_[triangle.normal[0]], normals_[triangle.normal[1]],
                                        normals_[triangle.normal[2]]};
      const Vec3d scaled = vec::scale(vec::cross(vec::subtract(b, a), vec::subtract(c, a)), 1 / (longest * longest));
      const bool usable = wanted && normals_usable(corner, vec::unit(scaled));
      if (wanted && !usable)
        notices_.note(
            "normals (vn) of a mirror, glass or glossy surface that point to its back are not used: flat there",
            origin);
      if (!usable) triangle.normal.fill(kNoNormal);
    }
    for (std::uint32_t& p : triangle.position) p = positions(p);
    for (std::uint32_t& n : triangle.normal)
      if (n != kNoNormal) n = normals(n);
    triangle.material = materials(triangle.material);
    if (triangle.texture_points != kNoImage) {
      const auto from = texture_points_.begin() + triangle.texture_points;
      triangle.texture_points = static_cast<std::uint32_t>(scene.texture_points.size());
      scene.texture_points.insert(scene.texture_points.end(), from, from + 3);
    }
    scene.triangles.push_back(triangle);
  }
  scene.positions = positions.take();
  scene.normals = normals.take();
  for (Vec3d& n : scene.normals) n = vec::unit(n);
  scene.materials = materials.take();
  scene.textures = textures_.take();
  scene.webs = webs_;
  scene.lamps = lamps_;
}

}  // namespace torolux
