// SPDX-License-Identifier: MIT
// Sky and sun at a PE: what a ray sees that leaves the object space, and the records of a point of an opening.
#pragma once

#include <cstdint>

#include "firmware/pe/pe.hpp"

namespace torolux::pe {

/// Towards `direction`, unit length; nothing where the scene has no sky.
glm::vec3 sky_towards(const Scene& scene, const glm::vec3& direction);

/// A ray that has left the object space adds what it sees. Of shadow rays only those do that looked for the sky.
void see_sky(Pe& pe, Niu& niu, const protocol::RayRecord& record);

/// Of a point of an opening: what of its flux belongs to the pixels that are meant goes into the tally; each record
/// takes out what it carries.
void begin_sky_pixels(Pe& pe, Expansion& expansion);
/// One pixel on: draws a direction and the flux that comes from there. False: none comes.
bool step_sky_pixel(Pe& pe, Expansion& expansion);
/// Where the pixel's light enters: each has a place of its own.
glm::vec3 sky_origin(const Scene& scene, const Expansion& expansion);

}  // namespace torolux::pe
