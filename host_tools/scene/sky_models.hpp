// SPDX-License-Identifier: MIT
// Published models of the sky: where the sun stands enters; radiance by direction leaves. Directions are of unit length
// in the sky's frame: east, north, up; radiance below the horizon is 0.
#pragma once

#include <functional>

#include "host_tools/scene/scene.hpp"

namespace torolux {

using SkyModel = std::function<Vec3d(const Vec3d&)>;

SkyModel uniform_sky(const Vec3d& radiance);

/// CIE traditional overcast sky (CIE S 011 / ISO 15469:2004, type 16; Moon & Spencer 1942): a third of the zenith's
/// radiance at the horizon.
SkyModel overcast_sky(const Vec3d& zenith);

/// CIE standard clear sky, low turbidity (CIE S 011 / ISO 15469:2004, type 12). sun: above the horizon.
SkyModel clear_sky(const Vec3d& zenith, const Vec3d& sun);

/// Preetham, Shirley & Smits 1999, "A practical analytic model for daylight", appendix; its luminance over
/// kLumenPerWatt. turbidity: 1.9 to 10; sun: above the horizon.
SkyModel preetham_sky(double turbidity, const Vec3d& sun);

}  // namespace torolux
