// SPDX-License-Identifier: MIT
// A lamp that is very small against its scene lights it as theory says, straight and by way of what it lights.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "tests/support/render_support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

constexpr double kIntensity = 2;    // along the lamp's axis [W/sr]
constexpr double kHeight = 1.5;     // of the lamp above the floor's middle
constexpr double kDiffuse = 0.5;    // of the floor
constexpr std::uint32_t kEdge = 4;  // of the picture [pixels]

/// A floor of 2 x 2 seen along the normal at its middle, and a square lamp over it.
std::string lamp_over_floor(double edge) {
  std::ostringstream text;
  text.precision(17);
  text << "[[quad]]\ncentre = [0.013, 0, 0.007]\nsize = [2, 2]\nfacing = [0, 1, 0]\nmaterial = 'floor'\n"
       << "[[quad]]\ncentre = [0, " << kHeight << ", 0]\nsize = [" << edge << ", " << edge
       << "]\nfacing = [0, -1, 0]\nmaterial = 'lamp'\n[material.floor]\ndiffuse = " << kDiffuse
       << "\n[material.lamp]\ndiffuse = 0\nemission = " << kIntensity / (edge * edge)
       << "\n[camera]\neye = [0.2, 1, 0]\nlook_at = [0, 0, 0]\nfov = 2\n";
  return text.str();
}

class SmallLamps : public testing::TestWithParam<bool> {};

// E = I / distance^2 under the lamp. Where each pixel counted in 2^-40 of the lamp's radiance, one of 1/200,000 of the
// scene lit nothing.
TEST_P(SmallLamps, LightAFloorAsLargerOnesDo) {
  const double expected = kDiffuse / std::numbers::pi * kIntensity / (kHeight * kHeight);
  // Of the least one some shadow rays pass by its edges, for rounding. Seen: 1.2 %, and 3.7 % of the least.
  for (const auto& [edge, off] : {std::pair{1e-2, 0.02}, {1e-4, 0.02}, {1e-5, 0.02}, {2e-6, 0.1}}) {
    const testing_support::TemporaryFolder folder;
    std::ofstream(folder.path() / "scene.toml") << lamp_over_floor(edge);
    RenderCase of = native_case(folder.path());
    of.quality.width = of.quality.height = kEdge;
    of.quality.samples = 256;
    of.quality.shadow_rays = GetParam();
    double seen = 0;
    for (const auto& pixel : run_case(of).picture.pixels) seen += double{pixel[1]} / (kEdge * kEdge);
    EXPECT_NEAR(seen / expected, 1, off) << edge;
  }
}

INSTANTIATE_TEST_SUITE_P(, SmallLamps, testing::Bool(),
                         [](const auto& of) { return of.param ? "ByShadowRays" : "ByElements"; });

}  // namespace
}  // namespace torolux::test
