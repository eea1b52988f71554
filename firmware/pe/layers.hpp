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

/// Whether a shadow ray from the surface that a record has met must go, whatever its weight: irradiance is asked for.
bool wants_irradiance(const Pe& pe, const protocol::RayRecord& record);

/// The record is to become a shadow ray from the surface that it has met, and would bring this light (irradiance / pi).
void note_irradiance(const Pe& pe, protocol::RayRecord& record, const glm::vec3& irradiance_over_pi);

/// Likewise of a ray to the sun, which waits for another one and is the only one that waits.
void note_sun_irradiance(protocol::RayRecord& record, const glm::vec3& irradiance_over_pi);

/// That ray is the record's way now.
void take_sun_irradiance(protocol::RayRecord& record);

/// What a pane lets pass of the light that note_irradiance() keeps: factors by channel.
void dim_irradiance(const Pe& pe, protocol::RayRecord& record, const glm::vec3& passed);

}  // namespace torolux::pe
