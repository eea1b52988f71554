// SPDX-License-Identifier: MIT
// An MGF file (Materials and Geometry Format 2.0; G. Ward, "The Materials and Geometry Format", Lawrence Berkeley
// Laboratory 1994-97) and the files that it includes enter; a mesh leaves. docs/mgf.md says how each entity is read.
#pragma once

#include <filesystem>

#include "host_tools/scene/imported_mesh.hpp"

namespace torolux {

/// More is refused. A test may allow less.
struct MgfLimits {
  std::size_t triangles = kMostTriangles;
  std::size_t repeated = 5'000'000;  ///< statements that arrays, and files that are included again, repeat
};

/// Lengths in metres, as the format has it, or whatever its transforms make of them. Lines of triangles are the file's
/// own: of what is included, the line that includes it. Throws InputError with file and line: what is not MGF, a name
/// or a file that is not there, files that include each other, what is beyond the limits.
ImportedMesh import_mgf(const std::filesystem::path& path, SceneFiles& files, const Place& asked_at, Notices& notices,
                        const MgfLimits& limits = {});

}  // namespace torolux
