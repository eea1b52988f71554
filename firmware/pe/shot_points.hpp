// SPDX-License-Identifier: MIT
// Where on a patch a shot leaves, and how much of its flux there. Enters: what each element has left to send; leaves: a
// point at a time.
#pragma once

#include "firmware/pe/scene.hpp"
#include "firmware/pe/shot.hpp"

namespace torolux::pe {

/// Before the first point: adds up what the shot's facets would send. Light that a patch reflects leaves where it came,
/// so that nothing leaves from below what stands on it. The elements count as shot from then on.
void begin_points(const Scene& scene, Shot& shot);

/// The shot's next point. Their shares of the flux add up to all of it exactly. Of a gathering: a GatherPointRecord's
/// bytes; home: of its element.
protocol::PointRecord make_point(const Scene& scene, Shot& shot, protocol::PeNumber home);

}  // namespace torolux::pe
