// SPDX-License-Identifier: MIT
// A shot in progress: where in the patch's points and the hemi-cube's pixels it is, and what it divides.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/pe/vectors.hpp"
#include "firmware/protocol/messages.hpp"
#include "firmware/protocol/records.hpp"
#include "firmware/protocol/stratified.hpp"

namespace torolux::pe {

/// Three directions at right angles: across, along, and away from a patch's side.
struct Frame {
  glm::vec3 x, y, z;
};

/// How far a walk over the facets of a patch, in their order, has come.
struct FacetWalk {
  std::uint32_t facet = 0;  ///< of the patch
  glm::vec3 before{};       ///< what the facets before it would send, R G B; any unit
};

struct Shot {
  bool active = false;
  protocol::Shoot command{};
  protocol::Flux flux{};      ///< of the whole shot [quanta]
  std::uint32_t grid = 0;     ///< k: k * k points
  std::uint32_t key = 0;      ///< of its random numbers
  std::uint32_t credits = 0;  ///< granted and not used yet
  std::uint32_t granted = 0;  ///< in all
  // Of the points: each stands for an equal part of what the facets would send, one behind the other.
  bool by_area = false;    ///< facets send by their area alone
  glm::vec3 all{};         ///< what all of them would send
  FacetWalk walk{};        ///< at the end of the current point's part
  protocol::Flux given{};  ///< of the flux, to the points up to the current one
  // Of the current point.
  std::uint32_t point = 0;
  std::uint32_t polygon = 0;  ///< index
  glm::vec3 origin{};
  bool seeks = false;  ///< the point lies outside the subspace that holds the patch's centre
  Frame frame{};       ///< spun, by the same turn at all points
  std::uint32_t point_key = 0;
  protocol::StratifiedPair within{};  ///< where in the pixels it goes through them; each has a shift of its own
  protocol::Flux share{};             ///< of the flux
  // Of the current pixel: the next record to create.
  std::uint32_t pixel = 0;
  std::uint32_t next_pixel = 0;
  protocol::Flux pixel_flux{};
  std::array<std::uint32_t, 3> rest{};  ///< of the share: less than a quantum, for the next pixel (next_part)
};

}  // namespace torolux::pe
