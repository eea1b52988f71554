// SPDX-License-Identifier: MIT
// Tiles of the picture that the host has dealt to a PE, and how far their rays have been made.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/protocol/camera_ray.hpp"
#include "firmware/protocol/cells.hpp"
#include "firmware/protocol/messages.hpp"
#include "firmware/protocol/stores.hpp"

namespace torolux::pe {

struct Tiles {
  /// At the beginning of a stage or a pass: none is held.
  void set(const protocol::StageLayout& layout);

  std::array<protocol::Tile, protocol::kTilePlaces> place{};
  std::uint32_t first = 0;  ///< of `place`: the current one
  std::uint32_t held = 0;   ///< from there on, going round
  // Of the current one: the next ray to make.
  std::uint32_t column = 0, row = 0;   ///< in the tile
  std::uint32_t sample = 0, made = 0;  ///< the sample, and how many of the pixel's came before it in this pass
  protocol::CameraPixel pixel{};
  // Of all rays of the pass (protocol::View); the first of a stage takes all samples.
  std::uint32_t first_sample = 0, count = 0, step = 0;
  bool eye_inside = false;          ///< the object space
  protocol::CellCode eye_cell = 0;  ///< then
  float weight = 0.0F;              ///< of a sample in its pixel
};

}  // namespace torolux::pe
