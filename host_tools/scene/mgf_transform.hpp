// SPDX-License-Identifier: MIT
// Arguments of MGF's xf enter; where they put things, with arrays one copy after the other, leaves.
#pragma once

#include <array>
#include <vector>

#include "host_tools/scene/mgf_statements.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

/// Turned, mirrored, scaled alike in all directions, and then moved.
struct MgfPlacement {
  std::array<Vec3d, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3d move{0, 0, 0};
  double scale = 1;       ///< above 0
  bool mirrored = false;  ///< fronts would become backs: faces are to be wound the other way

  Vec3d point(const Vec3d& p) const;
  /// Without the scale: of a unit vector, one.
  Vec3d direction(const Vec3d& d) const;
};

/// First `inner`, then `outer`.
MgfPlacement joined(const MgfPlacement& inner, const MgfPlacement& outer);

/// The transforms that are open, the innermost last; each with its copies.
class MgfTransforms {
 public:
  /// Begins one; arguments from number `first` on. Throws InputError: an unknown argument, a number that is none, a
  /// scale of zero, a count below 1, too many counts, what leaves the range of numbers.
  void open(const MgfStatement& statement, std::size_t first);
  /// Goes on to the innermost's next copy: true; or ends it: false. One must be open.
  bool next_copy();

  const MgfPlacement& current() const { return open_.empty() ? none_ : open_.back().placement; }
  std::size_t depth() const { return open_.size(); }

 private:
  enum class Kind : unsigned char { move, turn, scale, mirror };
  struct Step {
    Kind kind;
    std::size_t axis;  ///< of turn and mirror
    Vec3d values;      ///< of move; the first: degrees, or scale
  };
  /// Steps that are repeated together. Arrays ask for many copies: what does not change from one to the next is kept.
  struct Group {
    std::uint64_t times;       ///< of a repetition (-i); of an array (-a) its copies so far
    std::uint64_t copies = 0;  ///< of an array; 0: a repetition
    MgfPlacement once{};       ///< all steps
    MgfPlacement all{};        ///< as many times as that
  };
  struct Open {
    std::vector<Group> groups;
    MgfPlacement placement;
    Place place;
  };
  class Arguments;
  static Step read_step(Arguments& arguments);
  static MgfPlacement placement_of(const Step& step);
  void place(Open& open);

  std::vector<Open> open_;
  MgfPlacement none_;
};

}  // namespace torolux
