// SPDX-License-Identifier: MIT
// From linear radiance to what a display shows: white balance, exposure, tone curve, sRGB.
//
// Exposure 0 EV is automatic: the picture's middle luminance becomes kMiddleGrey. Then 1 EV is a factor of 2. The
// filmic curve has a toe (dark tones a little darker: contrast) and a shoulder (lamps and highlights are compressed,
// not cut off), leaves middle grey where it is, is monotone, and keeps the hue of every pixel.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host_tools/picture/picture.hpp"

namespace torolux {

/// Linear display value that the middle luminance is brought to at 0 EV.
inline constexpr double kMiddleGrey = 0.18;
/// Value of the brightest channel, in units of display white before the curve, that becomes display white.
inline constexpr double kWhite = 16;

/// Rec. 709, of a linear colour.
double luminance(const std::array<float, 3>& colour);

/// By which a picture is measured, ascending: those of the pixels that are not black, the darkest and the brightest
/// tenth of them left out, so that lamps in view do not make the room dark [W/(m^2 sr)]. None for a black picture.
std::vector<double> measured_luminances(const Picture& picture);

/// Middle luminance: the geometric mean of these [W/(m^2 sr)]; 0 for a black picture.
double middle_luminance(const Picture& picture);

/// The factor from radiance to linear display values before the curve. exposure_ev: in EV.
double exposure_factor(const Picture& picture, double exposure_ev);

/// The curve: linear, >= 0, unbounded -> linear, 0..1. What is not a finite number counts as 0.
std::array<float, 3> compress(const std::array<float, 3>& colour, ToneCurve curve);

/// Linear 0..1 -> sRGB 0..255 (IEC 61966-2-1), rounded to nearest.
std::uint8_t to_srgb(float linear);

/// Exposed by `factor`, through the curve: what a display shows, linear 0..1.
Picture shown(const Picture& picture, double factor, ToneCurve curve);

/// What is left to do once a picture is balanced.
inline ToneMapping without_balance(const ToneMapping& mapping) {
  return {mapping.exposure_ev, mapping.curve, {}};
}

/// The whole way: width * height * 3 bytes, R G B, row 0 on top.
std::vector<std::uint8_t> tone_map(const Picture& picture, const ToneMapping& mapping);

}  // namespace torolux
