// SPDX-License-Identifier: MIT
// From linear radiance to what a display shows: exposure, tone curve, sRGB.
//
// Exposure 0 EV is automatic: the picture's middle luminance becomes kMiddleGrey. Then 1 EV is a factor of 2. The curve
// keeps the hue of every pixel, is monotone, and is the identity up to kShoulder, so that walls look as they are and
// only lamps and highlights are compressed.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host_tools/picture/picture.hpp"

namespace torolux {

/// Linear display value that the middle luminance is brought to at 0 EV.
inline constexpr double kMiddleGrey = 0.18;
/// Linear display value of the brightest channel above which the curve bends towards 1.
inline constexpr float kShoulder = 0.5F;

/// Middle luminance: the geometric mean over the pixels that are not black, the darkest and the brightest tenth of them
/// left out, so that lamps in view do not make the room dark. [W/(m^2 sr)]; 0 for a black picture.
double middle_luminance(const Picture& picture);

/// The factor from radiance to linear display values before the curve. exposure_ev: in EV.
double exposure_factor(const Picture& picture, double exposure_ev);

/// The curve: linear, >= 0, unbounded -> linear, 0..1. What is not a finite number counts as 0.
std::array<float, 3> compress(const std::array<float, 3>& colour);

/// Linear 0..1 -> sRGB 0..255 (IEC 61966-2-1), rounded to nearest.
std::uint8_t to_srgb(float linear);

/// The whole way: width * height * 3 bytes, R G B, row 0 on top.
std::vector<std::uint8_t> tone_map(const Picture& picture, double exposure_ev);

}  // namespace torolux
