// SPDX-License-Identifier: MIT
// Scene, placement and layout enter; the contents of a PE's stores in a stage leave, byte for byte as they are loaded
// over the bus.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host_tools/irradiance/vertex_irradiance.hpp"
#include "host_tools/layout/light_units.hpp"
#include "host_tools/layout/stage_layout.hpp"

namespace torolux {

/// Of the camera rays, where PEs make them: as many as the layout has places for.
struct CameraTables {
  std::span<const protocol::SamplePlace> sample_places;
  std::span<const float> filter;
};

/// As of a PE that has nothing of its own (Placement::with_nobody): every PE's stores begin like these, and only what
/// it has beside is made for each.
struct PeLoad {
  protocol::StageLayout layout;
  std::vector<std::byte> image;  ///< from layout.cell_words.address on
};

/// Bytes from layout.cell_words.address up to PeLayout::load_end; a multiple of 4. common: of the same stage, or null.
/// With it or without, the bytes are the same.
std::vector<std::byte> radiosity_image(const Scene& scene, const Mesh& mesh, const Placement& placement,
                                       protocol::PeNumber pe, const LightUnits& units, const PeLayout& layout,
                                       const PeLoad* common = nullptr);
std::vector<std::byte> ray_tracing_image(const Scene& scene, const Mesh& mesh, const Placement& placement,
                                         protocol::PeNumber pe, const LightUnits& units,
                                         const VertexIrradiance& irradiance, const PeLayout& layout,
                                         const CameraTables& camera = {}, const PeLoad* common = nullptr);

}  // namespace torolux
