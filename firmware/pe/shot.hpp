// SPDX-License-Identifier: MIT
// A shot in progress: where in the patch's points and the hemi-cube's pixels it is, and what it divides.
#pragma once

#include <cstdint>

#include "firmware/pe/vectors.hpp"
#include "firmware/protocol/messages.hpp"
#include "firmware/protocol/records.hpp"

namespace torolux::pe {

/// Three directions at right angles: across, along, and away from a patch's side.
struct Frame {
  glm::vec3 x, y, z;
};

struct Shot {
  bool active = false;
  protocol::Shoot command{};
  protocol::Flux flux{};      ///< of the whole shot [quanta]
  std::uint32_t grid = 0;     ///< k: k * k points
  std::uint32_t credits = 0;  ///< granted and not used yet
  // Of the current point.
  std::uint32_t point = 0;
  glm::vec3 origin{};
  bool seeks = false;  ///< the point lies outside the subspace of the patch's centre
  Frame frame{};       ///< spun
  std::uint32_t key = 0;
  protocol::Flux share{};  ///< of the flux
  // Of the current pixel: the next record to create.
  std::uint32_t pixel = 0;
  std::uint32_t next_pixel = 0;
  protocol::Flux pixel_flux{};
  protocol::Flux passed{};   ///< of the share, to the pixels up to this one
  std::uint64_t weight = 0;  ///< of the pixels up to this one; 2^32 is all
};

}  // namespace torolux::pe
