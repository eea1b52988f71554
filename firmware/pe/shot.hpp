// SPDX-License-Identifier: MIT
// A shot at its owner, who makes its points; and a point at the PE that makes its records.
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
  bool active = false;  ///< points are left to be dealt
  protocol::Shoot command{};
  protocol::Flux flux{};     ///< of the whole shot [quanta]
  std::uint32_t points = 0;  ///< in all
  std::uint32_t key = 0;     ///< of its random numbers
  std::uint32_t point = 0;   ///< the next one
  bool by_area = false;      ///< facets send by their area alone
  bool apart = false;        ///< final gathering leaves its light to its records
  glm::vec3 all{};           ///< what all of them would send
  FacetWalk walk{};          ///< at the end of the last point's part: each has an equal part of what facets send
  protocol::Flux given{};    ///< of the flux, to the points before
  // Of a point that is dealt in parts.
  protocol::PointRecord divided{};
  std::uint32_t part = 0;  ///< the next one; 0: the next point
};

/// Where in a point's hemi-cube the next record is, and what it divides.
struct Expansion {
  bool active = false;
  protocol::PointRecord point{};
  std::uint32_t number = 0;     ///< of the point in its shot
  std::uint32_t key = 0;        ///< of the point's random numbers
  Frame frame{};                ///< spun, by the same turn at all points of the shot
  std::uint32_t end_pixel = 0;  ///< behind the last one that is meant
  std::uint32_t pixel = 0;      ///< the next record's
  protocol::Flux pixel_flux{};
  glm::vec3 direction{};       ///< of a point of sky and sun or a lamp: in which the pixel's light goes, unit length
  protocol::LampPoint lamp{};  ///< of a lamp's point
  std::uint32_t next_pixel = 0;
  protocol::StratifiedPair within{};  ///< where in the pixels the point goes through them; each has a shift of its own
  std::array<std::uint32_t, 3> rest{};  ///< of the flux: less than a quantum, for the next pixel (next_part)
};

}  // namespace torolux::pe
