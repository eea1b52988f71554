// SPDX-License-Identifier: MIT
// A scene of diffuse surfaces and lamps enters, without textures; the bytes of a file that says the same leave.
#pragma once

#include <string>

#include "host_tools/scene/scene.hpp"

namespace torolux {

/// A .glb: one primitive for each run of triangles of a material, positions as floats; a camera that stands where the
/// scene's does and looks along +z.
std::string as_glb(const Scene& scene);

/// An .mgf: a vertex for each position, a face for each triangle, all numbers in full. No camera: the format has none.
std::string as_mgf(const Scene& scene);

}  // namespace torolux
