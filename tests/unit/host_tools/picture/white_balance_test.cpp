// SPDX-License-Identifier: MIT
// Proves: the light that is named, or guessed, looks grey and stays as bright; near equal energy little changes; off
// leaves every byte; a dark wall or a lamp does not decide.
#include "host_tools/picture/white_balance.hpp"

#include <gtest/gtest.h>

#include "host_tools/colour/colour.hpp"
#include "host_tools/colour/white_point.hpp"
#include "host_tools/picture/reduce.hpp"
#include "host_tools/picture/tone_map.hpp"

namespace torolux {
namespace {

std::array<float, 3> times(const std::array<double, 3>& colour, double factor) {
  return {static_cast<float>(colour[0] * factor), static_cast<float>(colour[1] * factor),
          static_cast<float>(colour[2] * factor)};
}

TEST(WhitePoint, TheLightsOwnColourBecomesGreyOfTheSameLuminance) {
  for (const double kelvin : {1500.0, 2700.0, 4000.0, 6500.0, 20000.0}) {
    const auto light = light_of(kelvin);
    const auto grey = changed(adaptation_to(light), light);
    for (const double channel : grey) EXPECT_NEAR(channel, luminance(light), 1e-12) << kelvin;
  }
}

// Bradford's published change from illuminant A to D65 (B. Lindbloom), of XYZ: applied to the white of A it gives
// D65's. Here of a colour off the grey axis: XYZ (0.3, 0.4, 0.1) of A goes to (0.2529, 0.4073, 0.3083) by 0.8446965
// -0.1179225 0.3948108; -0.1366303 1.1041226 0.1291718; 0.0798489 -0.1348999 3.1924009.
TEST(WhitePoint, IsTheTransformOfBradford) {
  const auto to_rgb = [](const std::array<double, 3>& xyz) {
    const ColourMatrix from_xyz{
        {{3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}}};
    return changed(from_xyz, xyz);
  };
  const ColourMatrix published{
      {{0.8446965, -0.1179225, 0.3948108}, {-0.1366303, 1.1041226, 0.1291718}, {0.0798489, -0.1348999, 3.1924009}}};
  const std::array<double, 3> colour{0.3, 0.4, 0.1};
  const auto wanted = to_rgb(changed(published, colour));
  const auto found = changed(adaptation_to(to_rgb({1.09850, 1, 0.35585})), to_rgb(colour));
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], wanted[c], 2e-4) << "published with 7 digits";
}

TEST(WhiteBalance, NearEqualEnergyLittleChanges) {
  const Picture picture{1, 1, {{0.3F, 0.2F, 0.5F}}};
  const auto same = balanced(picture, {WhiteBalance::Kind::kelvin, 5455});
  ASSERT_TRUE(same);
  // No black body has equal energy; this one, the nearest, is a little greener: 6 % of blue.
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(same->pixels[0][c], picture.pixels[0][c], 0.07F * picture.pixels[0][c]);
}

TEST(WhiteBalance, OffLeavesEveryByte) {
  const Picture picture{2, 1, {{0.3F, 0.2F, 0.5F}, {0.01F, 3, 0.4F}}};
  EXPECT_FALSE(balanced(picture, {}));
  EXPECT_EQ(tone_map(picture, {0.5, ToneCurve::filmic, {}}), tone_map(picture, {0.5, ToneCurve::filmic}));
}

TEST(WhiteBalance, WarmGreysBecomeGreyInEveryPicture) {
  const auto light = light_of(2700);
  Picture picture{3, 1, {times(light, 0.2), times(light, 0.5), times(light, 1.1)}};
  for (const WhiteBalance& white :
       {WhiteBalance{WhiteBalance::Kind::kelvin, 2700}, WhiteBalance{WhiteBalance::Kind::automatic, 0}}) {
    const ToneMapping mapping{0, ToneCurve::filmic, white};
    const auto bytes = tone_map(picture, mapping);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      EXPECT_NEAR(bytes[i], bytes[i + 1], 1);
      EXPECT_NEAR(bytes[i], bytes[i + 2], 1);
    }
    EXPECT_EQ(reduce(picture, mapping, 3).bytes, bytes);
    const auto small = reduce(picture, mapping, 1).bytes;
    EXPECT_NEAR(small[0], small[2], 1);
  }
}

TEST(WhiteBalance, BrightSurfacesTellMoreThanDarkOnesAndALampNothing) {
  const auto light = light_of(3000);
  Picture picture{10, 10, {}};
  for (int i = 0; i < 100; ++i) picture.pixels.push_back(times(light, 0.5));
  for (std::size_t i = 0; i < 40; ++i) picture.pixels[i] = {0.05F, 0.002F, 0.002F};  // red and dark
  picture.pixels[99] = {0, 0, 1000};                                                 // one lamp of another colour
  const auto guessed = light_colour(picture);
  const double most = std::max({light[0], light[1], light[2]});
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(guessed[c], light[c] / most, 1e-4) << c;
}

TEST(WhiteBalance, PicturesThatTellNothingStayFinite) {
  EXPECT_EQ(light_colour({1, 1, {{0, 0, 0}}}), (std::array<double, 3>{1, 1, 1}));
  EXPECT_EQ(light_colour({1, 1, {{1, 0, 0}}}), (std::array<double, 3>{1, 0.05, 0.05}));
  EXPECT_EQ(light_colour({1, 1, {{std::numeric_limits<float>::infinity(), 0, 0}}}), (std::array<double, 3>{1, 1, 1}));
}

}  // namespace
}  // namespace torolux
