// SPDX-License-Identifier: MIT
// The solution enters; a mesh for other programs leaves: a PLY file (G. Turk, "The PLY polygon file format", 1994) of
// all elements' facets with the light at their corners.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "host_tools/irradiance/vertex_irradiance.hpp"
#include "host_tools/layout/light_units.hpp"

namespace torolux {

/// Binary, little-endian. Vertices: x, y, z in scene units; red, green, blue: radiosity B (reflected and emitted)
/// [W/m^2], float; element: global number. Faces: three vertices of their own each, so that neighbours may differ where
/// the light does; the front first, then, wound the other way, the back, as each has elements. A texture counts by its
/// mean over the patch.
std::vector<std::byte> pack_ply(const Scene& scene, const Mesh& mesh, const LightUnits& units,
                                const VertexIrradiance& irradiance);

/// Before the work. Throws InputError: it cannot be written; UsageError: it has the extension of another format.
void check_ply_writable(const std::filesystem::path& file);

/// Throws InputError where the file cannot be written; leaves none behind then.
void save_ply(const std::filesystem::path& file, const Scene& scene, const Mesh& mesh, const LightUnits& units,
              const VertexIrradiance& irradiance);

}  // namespace torolux
