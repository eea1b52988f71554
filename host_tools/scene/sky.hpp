// SPDX-License-Identifier: MIT
// Sky and sun: a radiance for each direction enters; the table that the machine keeps of it leaves, and sums over it.
#pragma once

#include <functional>
#include <vector>

#include "host_tools/scene/imported_mesh.hpp"
#include "host_tools/scene/notices.hpp"
#include "host_tools/scene/scene.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {

/// Half of the angle at which the sun is seen [degrees].
inline constexpr double kSunRadiusDegrees = 0.2665;

/// elevation, azimuth: in degrees, above the horizon and from north to east.
Vec3d sky_direction(const Sky& sky, double elevation, double azimuth);

/// The corners of the openings of a scene's sky, which are part of the object space wherever surfaces end.
void include_openings(const Scene& scene, vec::Box& box);
/// Of one of them.
void include_opening(const SkyQuad& opening, vec::Box& box);

/// The first of these suns shines where the sky has none of its own, or there is no sky; the others are told.
/// direction: in the scene's space, any length.
void take_suns(const std::vector<ImportedSun>& suns, std::optional<Sky>& sky, Notices& notices);

/// By cell of the machine's table (firmware/protocol/sky.hpp): its mean over the cell. radiance: of a unit direction in
/// the sky's frame: east, north, up.
std::vector<Vec3d> sky_table(const std::function<Vec3d(const Vec3d&)>& radiance);

/// The angle from the frame's x to its y at which a sector begins; kSkySectors: 2 pi [radian].
double sky_sector_begin(std::size_t sector);

/// [sr]
double sky_cell_solid_angle(std::size_t cell);

/// Of a surface that faces `normal` (unit length, scene axes), nothing before it, of sky and sun [W/m^2].
Vec3d sky_irradiance(const Sky& sky, const Vec3d& normal);
/// Radiance summed over all directions, the sun's included [W/m^2].
Vec3d sky_from_everywhere(const Sky& sky);
/// Of the sun's disc, its mean [W/(m^2 sr)].
Vec3d sun_radiance(const Sky& sky);
/// Greatest of all channels and cells, and of what a white surface that faces the sun sends [W/(m^2 sr)].
double greatest_sky_radiance(const Sky& sky);

}  // namespace torolux
