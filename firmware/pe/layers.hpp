// SPDX-License-Identifier: MIT
// Further layers of a picture, on request: what a ray's way tells besides light. Leaves: additions to other planes of
// the frame buffer. Nothing here changes what the colours' plane gets.
#pragma once

#include "firmware/pe/pe.hpp"

namespace torolux::pe {

/// A piece of a ray's way on this PE has ended. Call where layers are asked for.
void note_way(Pe& pe, Niu& niu, const protocol::RayRecord& record, const Way& way);

/// A ray has met a surface that is here.
void note_surface(Pe& pe, Niu& niu, const protocol::RayRecord& record, const Hit& hit,
                  const glm::vec3& irradiance_over_pi);

/// The record is to become a shadow ray from the surface that it has met, and would bring this light (irradiance / pi).
/// True: it must go, whatever its weight, as its irradiance is asked for.
bool note_irradiance(const Pe& pe, protocol::RayRecord& record, const glm::vec3& irradiance_over_pi);

/// What a pane lets pass of the light that note_irradiance() keeps: factors by channel.
void dim_irradiance(const Pe& pe, protocol::RayRecord& record, const glm::vec3& passed);

}  // namespace torolux::pe
