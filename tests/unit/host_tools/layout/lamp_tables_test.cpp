// SPDX-License-Identifier: MIT
// Proves: each side's table has the flux of the web's half; between its angles it is near the web; a spot of a few
// degrees is not blurred; lamps of one file share a table; chances rise to one.
#include "host_tools/layout/lamp_tables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host_tools/colour/colour.hpp"
#include "host_tools/scene/lamp_web.hpp"
#include "host_tools/scene/measured_lamp.hpp"

namespace torolux {
namespace {

Scene scene_of(const std::string& numbers) {
  Notices notices;
  const MeasuredLamp measured = read_ies("IESNA:LM-63-2002\nTILT=NONE\n" + numbers, "a.ies", notices);
  Scene scene;
  scene.webs.push_back(measured.web);
  scene.lamps.push_back(hung_lamp(measured, {0, -1, 0}, std::nullopt));
  return scene;
}

protocol::Vec3f direction_of(const SceneLamp& lamp, double gamma, double turn) {
  const double g = gamma * std::numbers::pi / 180;
  const double t = turn * std::numbers::pi / 180;
  protocol::Vec3f direction{};
  for (std::size_t i = 0; i < 3; ++i)
    direction[i] = static_cast<float>(std::cos(g) * lamp.nadir[i] + std::sin(g) * std::cos(t) * lamp.x[i] +
                                      std::sin(g) * std::sin(t) * lamp.y[i]);
  return direction;
}

/// Greatest difference between table and web, over the web's greatest intensity.
double worst(const Scene& scene) {
  const LampTables tables = lamp_tables(scene);
  const LampWeb& web = scene.webs[0];
  const std::array<double, 2> flux = flux_of(web);
  double error = 0;
  double most = 0;
  for (double gamma = 0.25; gamma < 180; gamma += 0.5) {
    if (std::abs(gamma - 90) < 1) continue;
    for (double turn = 1; turn < 360; turn += 7) {
      const double here = intensity_of(web, gamma, turn) * std::numbers::pi / (flux[0] + flux[1]);
      const double there = double{protocol::lamp_intensity(tables.lamps[0], gamma < 90 ? 0U : 1U, tables.values,
                                                           direction_of(scene.lamps[0], gamma, turn))};
      error = std::max(error, std::abs(here - there));
      most = std::max(most, here);
    }
  }
  return error / most;
}

const std::string kWide =
    "1 1000 1 7 3 1 2 0 0 0\n1 1 1\n0 15 30 45 60 90 150\n0 90 180\n"
    "100 200 300 250 100 20 0\n100 150 120 80 40 20 0\n100 90 60 30 10 35 0\n";
const std::string kSpot = "1 1000 1 5 1 1 2 0 0 0\n1 1 1\n0 2 4 6 90\n0\n1000 900 100 0 0\n";

TEST(LampTables, AreNearTheWeb) {
  EXPECT_LT(worst(scene_of(kWide)), 0.02);
  EXPECT_LT(worst(scene_of(kSpot)), 0.03) << "a spot of four degrees";
}

/// Sums up bilinear cells.
double flux_of_side(const LampTables& tables, const protocol::LampSide& side) {
  double sum = 0;
  for (std::uint32_t band = 0; band < side.bands; ++band)
    for (std::uint32_t s = 0; s < side.sectors; ++s) {
      const auto at = [&](std::uint32_t row, std::uint32_t column) {
        return double{tables.values[side.values + row * side.sectors + column % side.sectors]};
      };
      const double height = double{tables.values[side.heights + band]} - double{tables.values[side.heights + band + 1]};
      EXPECT_GT(height, 0);
      sum += (at(band, s) + at(band, s + 1) + at(band + 1, s) + at(band + 1, s + 1)) / 4 * height * 2 *
             std::numbers::pi / side.sectors;
    }
  return sum;
}

TEST(LampTables, EachSideHasTheFluxOfItsHalf) {
  const Scene scene = scene_of(kWide);
  const LampTables tables = lamp_tables(scene);
  for (std::size_t side = 0; side < 2; ++side) {
    EXPECT_NEAR(flux_of_side(tables, tables.lamps[0].side[side]), std::numbers::pi * scene.lamps[0].share[side], 1e-5);
    const protocol::LampSide& of = tables.lamps[0].side[side];
    EXPECT_EQ(tables.chances[of.chances + of.bands * of.sectors - 1], 0xFFFF'FFFFU);
  }
  const Scene spot = scene_of(kSpot);
  EXPECT_EQ(lamp_tables(spot).lamps[0].side[1].bands, 0U) << "nothing goes up";
  EXPECT_EQ(lamp_tables(spot).lamps[0].side[0].sectors, 1U);
}

TEST(LampTables, AreSharedByLampsOfOneFile) {
  Scene scene = scene_of(kWide);
  const std::size_t alone = lamp_tables(scene).values.size();
  scene.lamps.push_back(scene.lamps[0]);
  scene.lamps[1].x = {0, 0, 1};
  const LampTables tables = lamp_tables(scene);
  EXPECT_EQ(tables.values.size(), alone);
  EXPECT_EQ(tables.lamps[1].side[0].values, tables.lamps[0].side[0].values);
}

TEST(LampTables, WhatIsSeenIsBounded) {
  const Scene scene = scene_of(kSpot);
  const double seen = brightest_seen(scene)[0];
  const double brightest = 1000 / kLumenPerWatt * std::numbers::pi / flux_of(scene.webs[0])[0];
  EXPECT_NEAR(seen / brightest, 1, 0.1);
}

}  // namespace
}  // namespace torolux
