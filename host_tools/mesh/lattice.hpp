// SPDX-License-Identifier: MIT
// The lattice: from flux per element to irradiance per vertex, continuous over each smooth surface.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "firmware/protocol/stores.hpp"
#include "host_tools/mesh/mesh.hpp"

namespace torolux {

struct Lattice {
  std::vector<protocol::LatticeValue> values;
  /// By triangle and side: index of the first of lattice_size(element_level) values, or kNoSide.
  std::vector<std::array<std::uint32_t, 2>> first;
};

/// flux: incident, by global element (Mesh::elements of them), in quanta. watts_per_quantum: of the flux.
/// unit_radiance: values are irradiance / pi in this unit [W/(m^2 sr)].
/// A vertex takes the flux of all elements around it on its smooth surface, divided by their area. A vertex on an edge
/// whose other triangle is cut more coarsely is anchored: it lies on the line between that triangle's vertices.
Lattice make_lattice(const Mesh& mesh, std::span<const protocol::Flux> flux, double watts_per_quantum,
                     double unit_radiance);

}  // namespace torolux
