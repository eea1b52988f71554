// SPDX-License-Identifier: MIT
// The contents of a PE's stores in a stage, byte for byte as they are loaded over the bus.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host_tools/layout/light_units.hpp"
#include "host_tools/layout/stage_layout.hpp"
#include "host_tools/mesh/lattice.hpp"

namespace torolux {

/// Of the camera rays, where PEs make them: as many as the layout has places for.
struct CameraTables {
  std::span<const protocol::SamplePlace> sample_places;
  std::span<const float> filter;
};

/// Bytes from layout.cell_words.address up to PeLayout::load_end; a multiple of 4.
std::vector<std::byte> radiosity_image(const Scene& scene, const Mesh& mesh, const Placement& placement,
                                       protocol::PeNumber pe, const LightUnits& units, const PeLayout& layout);
std::vector<std::byte> ray_tracing_image(const Scene& scene, const Mesh& mesh, const Placement& placement,
                                         protocol::PeNumber pe, const LightUnits& units, const Lattice& lattice,
                                         const PeLayout& layout, const CameraTables& camera = {});

}  // namespace torolux
