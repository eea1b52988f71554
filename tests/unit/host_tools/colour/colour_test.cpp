// SPDX-License-Identifier: MIT
// Proves the colorimetry against published figures: the observer's table, illuminants, measured paints, primaries.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "host_tools/colour/cie_observer.hpp"
#include "host_tools/colour/colour.hpp"

namespace torolux {
namespace {

void expect_xy(const Chromaticity& colour, double x, double y, double tolerance) {
  EXPECT_NEAR(colour.x, x, tolerance);
  EXPECT_NEAR(colour.y, y, tolerance);
}

// CIE 15 gives these sums of its table at 5 nm. A wrong digit anywhere shows.
TEST(Colour, ObserverAddsUpAsPublished) {
  Triple sum{0, 0, 0};
  for (const auto& row : kObserver)
    for (std::size_t c = 0; c < 3; ++c) sum[c] += row[c];
  EXPECT_NEAR(sum[0], 21.3715, 1e-4);
  EXPECT_NEAR(sum[1], 21.3713, 1e-4);
  EXPECT_NEAR(sum[2], 21.3715, 1e-4);
}

TEST(Colour, EqualEnergyIsTheMiddle) {
  const Triple white = tristimulus(380, 780, std::array{1.0, 1.0});
  for (const double value : white) EXPECT_NEAR(value, 1, 1e-12);
  expect_xy(chromaticity(white), 1.0 / 3, 1.0 / 3, 1e-12);
}

// Illuminant A is a black body of 2856 K (CIE 15): 0.4476, 0.4074. Others: Wyszecki & Stiles, locus of black bodies.
TEST(Colour, BlackBodiesLieOnTheirLocus) {
  expect_xy(chromaticity(black_body(2856)), 0.4476, 0.4074, 1e-4);
  expect_xy(chromaticity(black_body(5000)), 0.3451, 0.3516, 1e-4);
  expect_xy(chromaticity(black_body(10000)), 0.2807, 0.2884, 1e-4);
  EXPECT_TRUE(std::isfinite(chromaticity(black_body(100)).x));
  EXPECT_TRUE(std::isfinite(chromaticity(black_body(1e9)).x));
}

// Measured with a spectrophotometer, and their photometric reflectances, from the specification of MGF (2.3). It
// samples at 10 nm, which moves the figure by some 1e-3 of itself.
TEST(Colour, SpectraOfPaintsHaveTheirReflectances) {
  const std::array beige{35.29, 44.87, 47.25, 47.03, 46.87, 47.00, 47.09, 47.15, 46.80, 46.17, 46.26,
                         48.74, 51.08, 51.31, 51.10, 51.11, 50.52, 50.36, 51.72, 53.61, 53.95, 52.08,
                         49.49, 48.30, 48.75, 49.99, 51.35, 52.75, 54.44, 56.34, 58.00};
  EXPECT_NEAR(tristimulus(400, 700, beige)[1], 50.78, 0.05);
  const std::array red_cloth{28.62, 27.96, 27.86, 28.28, 29.28, 30.49, 31.61, 32.27, 32.26, 31.83, 31.13,
                             30.07, 29.14, 29.03, 29.69, 30.79, 32.30, 33.90, 34.56, 34.32, 33.85, 33.51,
                             33.30, 33.43, 34.06, 35.26, 37.04, 39.41, 42.55, 46.46, 51.00};
  EXPECT_NEAR(tristimulus(400, 700, red_cloth)[1], 32.10, 0.05);
}

TEST(Colour, NeutralBecomesGreyOfTheSameReflectance) {
  const LinearColour grey = linear_colour({}, 0.4);
  for (const double channel : grey.rgb) EXPECT_NEAR(channel, 0.4, 1e-12);
  EXPECT_FALSE(grey.clipped);
}

// The brightness that a file states is the brightness that there is, whatever the colour.
TEST(Colour, LuminanceIsKept) {
  for (const Chromaticity colour : {Chromaticity{0.4476, 0.4074}, {0.2, 0.25}, {0.3, 0.5}, {0.7, 0.29}})
    EXPECT_NEAR(luminance(linear_colour(colour, 0.3).rgb), 0.3, 1e-12);
}

// The primaries of sRGB, seen by eyes adapted to D65, are where Bradford moves them for eyes adapted to equal energy
// (by the inverse of its matrix, worked out elsewhere); what lies beyond is clipped, and says so.
TEST(Colour, PrimariesAndWhatLiesBeyond) {
  const std::array<Chromaticity, 3> primaries{{{0.6461102, 0.3283682}, {0.3237422, 0.5850644}, {0.1525724, 0.0616849}}};
  constexpr Triple luminances{0.2126, 0.7152, 0.0722};
  for (std::size_t i = 0; i < 3; ++i) {
    const LinearColour primary = linear_colour(primaries[i], luminances[i]);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(primary.rgb[c], c == i ? 1 : 0, 1e-5);
  }
  const LinearColour green = linear_colour({0.07, 0.83}, 0.5);
  EXPECT_TRUE(green.clipped);
  EXPECT_EQ(green.rgb[0], 0);
  EXPECT_GT(green.rgb[1], 0.6);
}

}  // namespace
}  // namespace torolux
