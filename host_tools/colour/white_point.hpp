// SPDX-License-Identifier: MIT
// The colour of a light enters; the change of colours by which it looks white leaves.
#pragma once

#include <array>

namespace torolux {

/// Row by row, of linear red, green and blue (ITU-R BT.709).
using ColourMatrix = std::array<std::array<double, 3>, 3>;

/// The linear transform of von Kries in the cone responses of Bradford (K. Lam 1985, as CIECAM97s has it), from this
/// light's white to D65: the light's own colour becomes grey of the same luminance. light: linear, each 0 and up, its
/// luminance above 0.
ColourMatrix adaptation_to(const std::array<double, 3>& light);

/// Of a black body: as lamps of that temperature have it in scenes, where equal energy (near 5,500 K) is white. kelvin:
/// 100 to 1e9.
std::array<double, 3> light_of(double kelvin);

std::array<double, 3> changed(const ColourMatrix& matrix, const std::array<double, 3>& colour);

}  // namespace torolux
