// SPDX-License-Identifier: MIT
// What all paths that are followed for predictions have in common: chance, starts on emitters, the walk from subspace
// to subspace, and the work that it makes. No picture depends on it.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "host_tools/layout/placement.hpp"

namespace torolux {

/// Means per record.
struct PathWork {
  double starts = 0;    ///< segments that begin here
  double arrivals = 0;  ///< at this PE, from another one
  double visits = 0;    ///< subspaces entered
  double polygons = 0;  ///< in the lists of those
  double deposits = 0;  ///< light that falls on a patch of this PE's, or is shown
  double turns = 0;     ///< at mirror or glass, and by lobes

  PathWork& operator+=(const PathWork& other);
  PathWork& operator*=(double factor);
};

struct PathSample {
  std::vector<PathWork> of_pe;
  /// By triangle of the mesh, its front and its back: flux that falls there, of all that set out. Of light only.
  std::vector<std::array<double, 2>> hits;
  double forwarded = 0;  ///< deposits whose patch another PE owns
  double escaped = 0;    ///< paths that leave the object space

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
class SampleWalker {
 public:
  using Cell = std::array<std::uint32_t, 3>;

  /// sample: gets room for all PEs and triangles. heat: gets the ways of records too, if given.
  SampleWalker(const Mesh& mesh, const Placement& placement, PathSample& sample, Heat* heat = nullptr);

  /// A record begins. records: that it stands for.
  void begin(double records);

  /// From subspace to subspace until something is met; `cell` ends there.
  Meeting walk(const SampleRay& ray, Cell& cell);
  /// Light falls on a patch, which may be another PE's; its number. at: where it was met.
  std::uint32_t deposit(const Meeting& met, const Cell& at);
  /// From where the patch is at home to a point of it, as a record that goes on from there does.
  void seek(std::uint32_t patch, const Cell& to);

  PathWork& work_at(const Cell& cell) { return sample_.of_pe[pe_of(cell)]; }
  Cell cell_of(const Vec3d& point) const;
  protocol::PeNumber pe_of(const Cell& cell) const { return placement_.pe_of_cell[placement_.grid.index(cell)]; }

 private:
  void add_to_heat(CellIndex cell);

  const Mesh& mesh_;
  const Placement& placement_;
  PathSample& sample_;
  Heat* heat_;
  float records_ = 1;
  bool first_ = true;
};

}  // namespace torolux
