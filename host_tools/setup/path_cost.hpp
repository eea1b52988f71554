// SPDX-License-Identifier: MIT
// What all paths that are followed for predictions have in common: chance, starts on emitters, the walk from subspace
// to subspace, and the work that it makes. No picture depends on it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "host_tools/layout/placement.hpp"

namespace torolux {

/// Means per record.
struct PathWork {
  double starts = 0;      ///< segments that begin here
  double hand_overs = 0;  ///< of records that go on here
  double steps = 0;       ///< from one subspace into the next
  double visits = 0;      ///< subspaces looked into
  double boxes = 0;       ///< of polygons and of groups of them, compared there
  double tests = 0;       ///< of polygons whose boxes are met
  double deposits = 0;    ///< light that falls on a patch, or is shown
  double sent_light = 0;  ///< deposits that come from other PEs to this one's patches
  double turns = 0;       ///< at mirror or glass, and by lobes
  double aims = 0;        ///< points on emitters among which a shadow ray's end is chosen

  PathWork& operator+=(const PathWork& other);
  PathWork& operator*=(double factor);
};

struct PathSample {
  std::vector<PathWork> of_pe;
  /// By whichever PE has made the record: until it comes to a subspace that is not everywhere, or its light to a patch.
  PathWork anywhere;
  /// By triangle of the mesh, its front and its back: flux that falls there, of all that set out. Of light only.
  std::vector<std::array<double, 2>> hits;
  double escaped = 0;  ///< paths that leave the object space

  PathWork sum() const;
};

struct SampleRay {
  Vec3d origin, direction;
};

struct Meeting {
  const MeshTriangle* triangle = nullptr;  ///< none: the ray has left the object space
  double t = HUGE_VAL;
  double b1 = 0, b2 = 0;
};

Vec3d normal_of(const MeshTriangle& triangle);
/// normal: unit, of either side.
Vec3d mirrored(const Vec3d& direction, const Vec3d& normal);

class Chance {
 public:
  /// Not std::uniform_real_distribution: its numbers differ between libraries.
  double uniform() { return static_cast<double>(random_()) * 0x1p-32; }
  Vec3d cosine_direction(const Vec3d& normal);
  /// As densely as cos^exponent of the angle from the axis.
  Vec3d lobe_direction(const Vec3d& axis, double exponent);

 private:
  Vec3d sphere_direction();

  std::mt19937 random_{1};
};

/// Points on emitters, with equal chance for equal emitted flux.
class EmitterPoints {
 public:
  EmitterPoints(const Scene& scene, const Mesh& mesh);

  bool empty() const { return triangles_.empty(); }
  std::size_t count() const { return triangles_.size(); }
  struct Point {
    const MeshTriangle* triangle;
    Vec3d place;
  };
  Point point(Chance& chance) const;

 private:
  double flux_ = 0;
  std::vector<std::pair<double, const MeshTriangle*>> triangles_;  // with the sum of flux up to and with this one
};

/// Follows segments through the subspaces and adds up what that takes.
class PathCost {
 public:
  using Cell = std::array<std::uint32_t, 3>;

  /// sample: gets room for all PEs and triangles. heat: gets the ways of records too, if given.
  PathCost(const Mesh& mesh, const Placement& placement, PathSample& sample, Heat* heat = nullptr);

  /// A record begins, at whichever PE has made it: scheme `paper`, or a single PE: who owns `cell`. records: that it
  /// stands for.
  void begin(double records, const Cell& cell);

  /// From subspace to subspace until something is met; `cell` ends there.
  Meeting walk(const SampleRay& ray, Cell& cell);
  /// Light falls on a patch, which may be another PE's; its number.
  std::uint32_t deposit(const Meeting& met);
  /// A ray sees the surface that it has met, at whoever has it.
  void see(const Meeting& met);
  /// The record goes on from where a patch is at home.
  void go_to_patch(std::uint32_t patch) { at_ = placement_.patch_home[patch].pe; }

  /// Of the PE where the record is.
  PathWork& work() { return at_ ? sample_.of_pe[*at_] : sample_.anywhere; }
  Cell cell_of(const Vec3d& point) const;

 private:
  /// Of the PEs, those at which a record that may be anywhere is not, or 1 where it is known to be elsewhere.
  double elsewhere() const;
  void enter(CellIndex cell);
  void look_into(const SampleRay& ray, CellIndex index, const Cell& cell, double from, double to);
  void add_to_heat(CellIndex cell);

  const Mesh& mesh_;
  const Placement& placement_;
  PathSample& sample_;
  Heat* heat_;
  std::optional<protocol::PeNumber> at_;  ///< where the record is; none: anywhere
  float records_ = 1;
  bool first_ = true;
};

}  // namespace torolux
