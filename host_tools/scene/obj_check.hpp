// SPDX-License-Identifier: MIT
// The check before tinyobjloader: OBJ text in; good statements, exact coordinates and lines of faces out.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "host_tools/scene/imported_mesh.hpp"

namespace torolux {

struct NameUse {
  std::string name;
  Place place;
};

/// Why a position cannot be used.
struct UnusablePosition {
  Place place;
  std::string message;
};

/// An index of a normal or texture point that names none, whatever stands in the file.
inline constexpr std::uint32_t kIndexOfNone = 0x7FFF'FFFFU;

struct CheckedObj {
  std::vector<Vec3d> positions;  ///< as far as they can be read
  std::map<std::uint32_t, UnusablePosition> unusable_positions;
  std::vector<Vec3d> normals;                         ///< NaN where it is not three finite numbers
  std::vector<std::array<double, 2>> texture_points;  ///< likewise
  std::vector<NameUse> libraries;
  std::vector<NameUse> materials;  ///< by first use; number i is called "i" in `text`; "" where usemtl has no name
  /// `f` with indices from 1 and `usemtl` with numbers: what tinyobjloader is given. Indices of positions are there;
  /// those of normals and texture points may be beyond the last.
  std::string text;
  std::vector<std::uint32_t> face_lines;
};

/// Throws InputError with file and line: a face that names a position that is not there, or by no number; too much.
CheckedObj check_obj(std::string_view text, const std::string& file, Notices& notices);

}  // namespace torolux
