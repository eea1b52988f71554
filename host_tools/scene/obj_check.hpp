// SPDX-License-Identifier: MIT
// The check before tinyobjloader: OBJ text in; good statements, exact coordinates and lines of faces out.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host_tools/scene/imported_mesh.hpp"

namespace torolux {

struct NameUse {
  std::string name;
  Place place;
};

struct CheckedObj {
  std::vector<Vec3d> positions;
  std::vector<Vec3d> normals;
  std::vector<std::array<double, 2>> texture_points;
  std::vector<NameUse> libraries;
  std::vector<NameUse> materials;  ///< by first use; number i is called "i" in `text`
  /// `f` with indices from 1 and `usemtl` with numbers: what tinyobjloader is given.
  std::string text;
  std::vector<std::uint32_t> face_lines;
};

/// Throws InputError with file and line.
CheckedObj check_obj(std::string_view text, const std::string& file, Notices& notices);

}  // namespace torolux
