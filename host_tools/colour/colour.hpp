// SPDX-License-Identifier: MIT
// Spectra, temperatures and CIE chromaticities enter; linear red, green and blue (primaries of sRGB) leave.
#pragma once

#include <array>
#include <functional>
#include <span>

namespace torolux {

using Triple = std::array<double, 3>;

/// CIE 1931 x and y. What is told apart by them has no brightness.
struct Chromaticity {
  double x = 1.0 / 3, y = 1.0 / 3;  ///< of equal energy

  bool operator==(const Chromaticity&) const = default;
};

/// CIE 1931 XYZ, standard observer of 2 degrees; a spectrum that is 1 everywhere has X = Y = Z = 1.
Triple tristimulus(const std::function<double(double nanometers)>& spectrum);
/// Values at even steps from `first` to `last` nanometers, straight between them, 0 elsewhere. At least two values.
Triple tristimulus(double first, double last, std::span<const double> values);
/// Of a black body (Planck's law, c2 = 14388 um K), up to a factor. kelvin: 100 to 1e9.
Triple black_body(double kelvin);

/// Y above 0.
Chromaticity chromaticity(const Triple& tristimulus);
/// X, Y and Z of a colour whose Y is `luminance`.
Triple tristimulus(const Chromaticity& colour, double luminance);

/// Of linear red, green and blue (ITU-R BT.709).
double luminance(const Triple& rgb);

struct LinearColour {
  Triple rgb;            ///< each 0 and up
  bool clipped = false;  ///< it lies outside of what the primaries can mix, and is replaced by the nearest in hue
};
/// Equal energy becomes grey: white is adapted from equal energy to D65 (Bradford). The colour's luminance is kept
/// exactly.
LinearColour linear_colour(const Chromaticity& colour, double luminance);

/// Watts of radiant power that stand for one lumen of white light: 1 / 179, as Radiance has it.
inline constexpr double kLumenPerWatt = 179;

}  // namespace torolux
