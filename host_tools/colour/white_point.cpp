// SPDX-License-Identifier: MIT
// Cone responses, each scaled by itself.
#include "host_tools/colour/white_point.hpp"

#include "host_tools/colour/colour.hpp"

namespace torolux {
namespace {

/// Linear red, green and blue (by the matrix of IEC 61966-2-1) into cone responses of Bradford, and back.
constexpr ColourMatrix kCones{{{0.4227253066602373, 0.49134528984985704, 0.027357931006333158},
                               {0.05569966095947373, 0.9615340134311382, 0.0231838235557641},
                               {0.021382652907183254, 0.08764189819640404, 0.9805081047709444}}};
constexpr ColourMatrix kFromCones{{{2.53804403913589, -1.2932767170360702, -0.04023682650373315},
                                   {-0.14600372779718324, 1.1166481780947315, -0.022329049924768866},
                                   {-0.042298549805236604, -0.07160723960446692, 1.022752719264684}}};

}  // namespace

std::array<double, 3> changed(const ColourMatrix& matrix, const std::array<double, 3>& colour) {
  std::array<double, 3> result{};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t c = 0; c < 3; ++c) result[row] += matrix[row][c] * colour[c];
  return result;
}

ColourMatrix adaptation_to(const std::array<double, 3>& light) {
  const double grey = luminance(light);
  const auto from = changed(kCones, light);
  const auto to = changed(kCones, {grey, grey, grey});
  ColourMatrix result{};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t cone = 0; cone < 3; ++cone)
        result[row][c] += kFromCones[row][cone] * (to[cone] / from[cone]) * kCones[cone][c];
  return result;
}

std::array<double, 3> light_of(double kelvin) {
  return linear_colour(chromaticity(black_body(kelvin)), 1).rgb;
}

}  // namespace torolux
