// SPDX-License-Identifier: MIT
// Finds overlapping triangles in planes across an axis.
#include "host_tools/scene/coplanar.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

namespace torolux {
namespace {

using Point = std::array<double, 2>;

struct Flat {
  std::size_t axis;
  double at;
  std::array<Point, 3> corners;
  std::uint32_t material;
  bool upwards;      // its front, along the axis
  double low, high;  // along the first of the two other axes
};

bool turns_left(const std::array<Point, 3>& p) {
  return (p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]) > 0;
}

/// Does a line along an edge of `a` part the two? Touching counts as apart.
bool parted_by_edge(const std::array<Point, 3>& a, const std::array<Point, 3>& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Point& p = a[i];
    const Point& q = a[(i + 1) % 3];
    const auto side = [&](const Point& r) { return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]); };
    const double inner = side(a[(i + 2) % 3]);
    if (std::all_of(b.begin(), b.end(), [&](const Point& r) { return side(r) * inner <= 0; })) return true;
  }
  return false;
}

std::vector<Flat> flat_triangles(const Scene& scene) {
  std::vector<Flat> flats;
  for (const SceneTriangle& triangle : scene.triangles) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double at = scene.positions[triangle.position[0]][axis];
      if (at != scene.positions[triangle.position[1]][axis] || at != scene.positions[triangle.position[2]][axis])
        continue;
      Flat flat{axis, at, {}, triangle.material, false, 0, 0};
      for (std::size_t i = 0; i < 3; ++i) {
        const auto& p = scene.positions[triangle.position[i]];
        flat.corners[i] = {p[(axis + 1) % 3], p[(axis + 2) % 3]};
      }
      flat.upwards = turns_left(flat.corners);
      flat.low = std::min({flat.corners[0][0], flat.corners[1][0], flat.corners[2][0]});
      flat.high = std::max({flat.corners[0][0], flat.corners[1][0], flat.corners[2][0]});
      flats.push_back(flat);
    }
  }
  std::sort(flats.begin(), flats.end(), [](const Flat& a, const Flat& b) {
    return std::tie(a.axis, a.at, a.low, a.high, a.material) < std::tie(b.axis, b.at, b.low, b.high, b.material);
  });
  return flats;
}

bool is_glass(const Scene& scene, std::uint32_t material) {
  return scene.materials[material].kind == SurfaceKind::glass;
}

/// What stands on another with a face of its own: nobody sees either there, unless light gets through one of them.
bool hide_each_other(const Scene& scene, const Flat& a, const Flat& b) {
  return a.upwards != b.upwards && !is_glass(scene, a.material) && !is_glass(scene, b.material);
}

std::string advice(const Scene& scene, std::uint32_t a, std::uint32_t b) {
  if (!is_glass(scene, a) && !is_glass(scene, b))
    return "which of them a ray meets is decided by its rounding, so they are speckled there; move one of them";
  const std::string& glass = scene.materials[is_glass(scene, a) ? a : b].name;
  return "which of them a ray meets is decided by its rounding, so they may be speckled there; move '" + glass +
         "' away from the other, or into it, by a ten-thousandth of the scene's size";
}

}  // namespace

void inspect_coplanar(const Scene& scene, std::vector<std::string>& found) {
  const std::vector<Flat> flats = flat_triangles(scene);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> pairs;
  std::size_t tests_left = 5'000'000;
  for (std::size_t i = 0; i < flats.size(); ++i) {
    for (std::size_t k = i + 1; k < flats.size() && flats[k].axis == flats[i].axis && flats[k].at == flats[i].at &&
                                flats[k].low < flats[i].high;
         ++k) {
      if (tests_left == 0) break;
      --tests_left;
      if (flats[i].material == flats[k].material || hide_each_other(scene, flats[i], flats[k])) continue;
      if (parted_by_edge(flats[i].corners, flats[k].corners) || parted_by_edge(flats[k].corners, flats[i].corners))
        continue;
      ++pairs[std::minmax(flats[i].material, flats[k].material)];
    }
  }
  constexpr std::size_t most_told = 8;
  std::size_t told = 0;
  for (const auto& [pair, count] : pairs) {
    if (told++ == most_told) {
      found.push_back(std::to_string(pairs.size() - most_told) + " more pairs of materials overlap in one plane");
      break;
    }
    found.push_back("'" + scene.materials[pair.first].name + "' and '" + scene.materials[pair.second].name +
                    "' overlap in one plane (" + std::to_string(count) + " pairs of triangles); " +
                    advice(scene, pair.first, pair.second));
  }
}

}  // namespace torolux
