// SPDX-License-Identifier: MIT
// The rule of surfaces in one plane: what is cut out under what, and what is moved apart.
#include "host_tools/scene/part_overlaps.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "host_tools/scene/flat_surfaces.hpp"
#include "host_tools/scene/keep_on.hpp"
#include "host_tools/scene/overlap_cutter.hpp"

namespace torolux {
namespace {

/// What must not lie in one place is moved apart by this, of the scene's longest edge.
constexpr double kApart = 1e-5;

bool are_opposite(const FlatSurface& a, const FlatSurface& b) {
  return vec::dot(a.normal, b.normal) < 0;
}

bool are_equal_in_size(const FlatSurface& a, const FlatSurface& b) {
  return std::abs(a.area - b.area) <= 1e-6 * (a.area + b.area);
}

/// Moves triangles by steps that are given for the triangles they come from; what does not move keeps its corners.
void move_apart(Scene& scene, const std::vector<std::uint32_t>& origin, const std::map<std::uint32_t, Vec3d>& steps) {
  std::map<std::pair<std::uint32_t, Vec3d>, std::uint32_t> moved;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    const auto step = steps.find(origin[t]);
    if (step == steps.end()) continue;
    for (std::uint32_t& p : scene.triangles[t].position) {
      const auto [entry, fresh] =
          moved.emplace(std::pair(p, step->second), static_cast<std::uint32_t>(scene.positions.size()));
      if (fresh) scene.positions.push_back(vec::add(scene.positions[p], step->second));
      p = entry->second;
    }
  }
}

/// Goes through the pairs, and finds what to do with each.
class Parting {
 public:
  Parting(Scene& scene, Notices& notices, const Place& place, const vec::Box& box)
      : scene_(scene),
        notices_(notices),
        place_(place),
        size_(vec::largest(box.extent())),
        surfaces_(flat_surfaces(scene, size_)),
        pairs_(pairs_in_one_plane(scene, surfaces_, size_)),
        cutter_(scene, surfaces_, box) {}

  void run() {
    if (pairs_.too_many) tell_too_many();
    if (pairs_.pairs.empty()) return;
    std::vector<std::uint32_t> involved;
    for (const auto& [upper, lower] : pairs_.pairs) involved.insert(involved.end(), {upper, lower});
    std::ranges::sort(involved);
    involved.erase(std::unique(involved.begin(), involved.end()), involved.end());
    for (const std::uint32_t s : involved) cutter_.add_vertices(s);
    for (const auto& [upper, lower] : pairs_.pairs) {
      look_for_interruption();
      if (!moves_apart(upper, lower)) cut(upper, lower);
    }
    std::vector<std::uint32_t> origin(scene_.triangles.size());
    std::iota(origin.begin(), origin.end(), std::uint32_t{0});
    if (any_cut_) origin = cutter_.finish(involved);
    if (cutter_.leaves_whole()) tell_too_many();
    move_apart(scene_, origin, steps_);
  }

 private:
  const SceneMaterial& material(std::uint32_t surface) const {
    return scene_.materials[scene_.triangles[surfaces_[surface].triangles[0]].material];
  }
  void tell_too_many() {
    if (std::exchange(told_too_many_, true)) return;
    notices_.note(
        "so many surfaces lie in one plane that not all were looked at: take out what lies below others, or it may "
        "show",
        place_);
  }
  std::string name(std::uint32_t surface) const { return "'" + material(surface).name + "'"; }

  bool look_alike(std::uint32_t a, std::uint32_t b) const {
    SceneMaterial other = material(b);
    other.name = material(a).name;
    return other == material(a);
  }

  void move(std::uint32_t surface, double way) {
    for (const std::uint32_t t : surfaces_[surface].triangles)
      steps_.emplace(t, vec::scale(surfaces_[surface].normal, way * kApart * size_));
  }

  /// What is seen from both sides, and different there. The upper one stays where it is, so that what it closes stays
  /// closed.
  bool moves_apart(std::uint32_t upper, std::uint32_t lower) {
    const FlatSurface& a = surfaces_[upper];
    const FlatSurface& b = surfaces_[lower];
    if (!are_opposite(a, b)) return a.glass;
    if (a.emits && b.emits) {
      notices_.note("two emitters lie back to back in one plane: moved apart a little", place_, name(lower));
      move(upper, 1);
      move(lower, 1);
      return true;
    }
    if (!are_equal_in_size(a, b) || (!a.glass && look_alike(upper, lower)) || !cutter_.covers(upper, lower))
      return a.glass;
    if (a.glass) {
      notices_.note("two glass faces back to back are a thin pane: moved apart a little", place_, name(lower));
      move(upper, 1);
      move(lower, 1);
    } else {
      notices_.note("a surface that stands twice, its fronts both ways and different, shows each on its side", place_,
                    name(upper) + " and " + name(lower));
      move(lower, 2);
    }
    return true;
  }

  void cut(std::uint32_t upper, std::uint32_t lower) {
    switch (cutter_.cut(upper, lower)) {
      case OverlapCutter::Found::nothing:
        return;
      case OverlapCutter::Found::too_long:
        tell_too_many();
        break;
      case OverlapCutter::Found::too_many_pieces:
        notices_.note(
            "so much lies on one triangle that it stays whole below it: they overlap in one plane; divide it, or move "
            "it down",
            place_, name(upper) + " on " + name(lower));
        break;
      case OverlapCutter::Found::cut:
        if (are_opposite(surfaces_[upper], surfaces_[lower]) &&
            std::ranges::all_of(surfaces_[lower].triangles, [&](std::uint32_t t) { return cutter_.is_gone(t); }))
          notices_.note("a surface that stands twice, its fronts both ways, is one with two sides", place_,
                        name(upper));
        else
          notices_.note("surfaces overlap in one plane: emitters lie on top, then the smaller one", place_,
                        name(upper) + " on " + name(lower));
    }
    any_cut_ = true;
  }

  Scene& scene_;
  Notices& notices_;
  const Place& place_;
  double size_;  ///< [scene units]
  std::vector<FlatSurface> surfaces_;
  PlanePairs pairs_;
  OverlapCutter cutter_;
  std::map<std::uint32_t, Vec3d> steps_;  ///< by triangle
  bool any_cut_ = false, told_too_many_ = false;
};

}  // namespace

void part_overlaps(Scene& scene, Notices& notices, const Place& place) {
  vec::Box box;
  for (const Vec3d& p : scene.positions) box.include(p);
  Parting(scene, notices, place, box).run();
}

}  // namespace torolux
