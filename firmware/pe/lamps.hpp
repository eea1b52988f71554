// SPDX-License-Identifier: MIT
// Measured lamps at a PE: the records of their points, what they send towards a place, and what a ray sees of them.
#pragma once

#include <cstdint>
#include <optional>

#include "firmware/pe/scene.hpp"
#include "firmware/pe/shot.hpp"
#include "firmware/pe/vectors.hpp"
#include "firmware/protocol/records.hpp"

namespace torolux::pe {

inline bool is_of_lamp(const protocol::PointRecord& point) {
  return (point.flags & protocol::kLamp) != 0;
}

/// Writes into a point whose light it is, in place of the normal.
void name_lamp(std::uint32_t lamp, std::uint32_t side, protocol::PointRecord& point);
/// Reads it back. Absent: the scene has no such lamp, or it is dark on that side.
std::optional<protocol::LampPoint> lamp_of(const Scene& scene, const protocol::PointRecord& point);

/// One pixel on: all have equal shares of the point's flux, and each draws a direction of its own. False: it gets none.
bool step_lamp_pixel(const Scene& scene, Expansion& expansion);

/// Intensity towards a place, in units of the material's emission times the lamp's area. direction: unit length, away
/// from the lamp.
float lamp_light(const Scene& scene, std::uint32_t lamp, const glm::vec3& direction);
/// Radiance seen, in units of the material's emission. direction: likewise.
float lamp_seen(const Scene& scene, std::uint32_t lamp, const glm::vec3& direction);

}  // namespace torolux::pe
