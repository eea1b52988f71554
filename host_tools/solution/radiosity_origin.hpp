// SPDX-License-Identifier: MIT
// What a saved solution was made from, and whether a run may take it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "host_tools/settings/quality.hpp"
#include "host_tools/solution/solution.hpp"

namespace torolux {

/// What a solution depends on: the scene's geometry and materials, and those settings of the picture that bear on
/// elements. Camera, picture size, samples and machine are not among it.
struct RadiosityOrigin {
  std::uint64_t geometry = 0;   ///< hash of positions and triangles
  std::uint64_t materials = 0;  ///< hash of all materials
  Quality quality;              ///< what bears on elements (host_tools/settings/options.hpp); the rest as built in
  std::uint32_t patch_sides = 0, elements = 0;  ///< of the mesh
};

RadiosityOrigin radiosity_origin(const Scene& scene, const Quality& quality, const Mesh& mesh);

/// As the file has it, little-endian.
using OriginBytes = std::array<std::byte, 128>;
OriginBytes bytes_of(const RadiosityOrigin& origin);
/// Any bytes are read; what they cannot mean is not equal to any run's, or the nearest that they can.
RadiosityOrigin origin_of(const OriginBytes& bytes);

/// Throws InputError with what differs, and the options that mend it. The mesh is not looked at. name: of the file.
void check_origin_settings(const RadiosityOrigin& saved, const RadiosityOrigin& run, const std::string& name);

}  // namespace torolux
