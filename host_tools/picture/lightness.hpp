// SPDX-License-Identifier: MIT
// Colours as an eye judges them: linear display values enter, CIE coordinates leave.
#pragma once

#include <array>

namespace torolux {

/// Linear, of the primaries of sRGB, 0..1 -> CIE XYZ, each divided by display white's (D65). From IEC 61966-2-1.
std::array<double, 3> relative_xyz(const std::array<double, 3>& linear);

/// The other way round.
std::array<double, 3> linear_of_xyz(const std::array<double, 3>& relative);

/// CIE 1976 L* a* b* of such coordinates: L* 0..100, for black to display white; 1 is about what can just be seen.
std::array<double, 3> lab_of_xyz(const std::array<double, 3>& relative);

}  // namespace torolux
