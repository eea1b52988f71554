// SPDX-License-Identifier: MIT
// A path segment's way through this PE's subspaces: ends at the first polygon that it meets, at another PE's subspace,
// or outside the object space.
#pragma once

#include <cstdint>

#include "firmware/pe/scene.hpp"
#include "firmware/pe/segment.hpp"
#include "firmware/protocol/machine.hpp"

namespace torolux::pe {

/// The point at which light meets a polygon.
struct Hit {
  float t;
  float b1, b2;           ///< weights of corners 1 and 2
  std::uint32_t polygon;  ///< index into this PE's polygons
  bool front;             ///< the ray comes from the polygon's front (d.n < 0)
};

enum class WayEnd : std::uint8_t {
  hit,
  handed_on,  ///< PE `next` has the subspace at segment.place, or a copy of it
  escaped,
};

struct Way {
  WayEnd end;
  protocol::PeNumber next;
  Hit hit;
  std::uint32_t visited;  ///< subspaces that this PE holds through which it went
};

/// `segment` is moved along.
Way traverse(const Scene& scene, Segment& segment);

}  // namespace torolux::pe
