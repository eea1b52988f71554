// SPDX-License-Identifier: MIT
// Proves: irradiances that theory knows come out of the table (uniform, overcast, sun); models have their known values;
// the frame turns from north to east; what [sky] may not say is refused with its line.
#include "host_tools/scene/sky.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>

#include "emulator/errors.hpp"
#include "firmware/protocol/sky.hpp"
#include "host_tools/colour/colour.hpp"
#include "host_tools/picture/formats.hpp"
#include "host_tools/scene/load_scene.hpp"
#include "host_tools/scene/scene_file.hpp"
#include "host_tools/scene/sky_image.hpp"
#include "host_tools/scene/sky_models.hpp"
#include "host_tools/scene/vec.hpp"
#include "tests/support/memory_files.hpp"

namespace torolux {
namespace {

constexpr double kPi = std::numbers::pi;

Sky sky_of(const std::string& table) {
  return read_scene_file("[sky]\n" + table, "scene.toml").sky.value();
}

TEST(Sky, CellsFillTheSphere) {
  double sum = 0;
  for (std::size_t cell = 0; cell < protocol::kSkyCells; ++cell) sum += sky_cell_solid_angle(cell);
  EXPECT_NEAR(sum, 4 * kPi, 1e-12);
}

TEST(Sky, AUniformOneGivesPiTimesItsRadiance) {
  const Sky sky = sky_of("radiance = [2, 1, 0]\nground = 0\n");
  EXPECT_NEAR(sky_irradiance(sky, {0, 1, 0})[0], 2 * kPi, 1e-3);
  EXPECT_NEAR(sky_irradiance(sky, {0, 1, 0})[1], kPi, 1e-3);
  EXPECT_NEAR(sky_irradiance(sky, {1, 0, 0})[0], kPi, 2e-3) << "a wall sees half of it";
  EXPECT_NEAR(sky_irradiance(sky, {0, -1, 0})[0], 0, 1e-12);
  EXPECT_NEAR(sky_from_everywhere(sky)[0], 4 * kPi, 1e-9);
}

// 7/9 pi Lz on level ground (Moon & Spencer 1942), less 0.06 % by the bands, each of which has its mean; the ground
// sends a fifth of it up, over pi.
TEST(Sky, AnOvercastOneGivesSevenNinths) {
  const Sky sky = sky_of("model = \"overcast\"\nzenith = 9\n");
  EXPECT_NEAR(sky_irradiance(sky, {0, 1, 0})[1], 7 * kPi, 0.02);
  EXPECT_NEAR(sky_irradiance(sky, {0, -1, 0})[1], 0.2 * 7 * kPi, 5e-3);
}

TEST(Sky, TheSunGivesItsIrradianceTimesTheCosine) {
  const Sky sky = sky_of("ground = 0\n[sky.sun]\nelevation = 30\nazimuth = 90\nirradiance = 8\n");
  EXPECT_NEAR(sky.sun[0], std::sqrt(0.75), 1e-12) << "east is x";
  EXPECT_NEAR(sky_irradiance(sky, {0, 1, 0})[2], 4, 1e-9);
  EXPECT_NEAR(sky_irradiance(sky, {1, 0, 0})[2], 8 * std::sqrt(0.75), 1e-9);
  EXPECT_NEAR(sky_irradiance(sky, {-1, 0, 0})[2], 0, 1e-9);
}

TEST(Sky, NorthIsBackAndTurnsToEast) {
  const Sky y_up = sky_of("radiance = 1\n");
  EXPECT_NEAR(sky_direction(y_up, 0, 0)[2], -1, 1e-12);
  EXPECT_NEAR(sky_direction(y_up, 0, 90)[0], 1, 1e-12);
  const Sky z_up = sky_of("radiance = 1\nup = [0, 0, 2]\n");
  EXPECT_NEAR(sky_direction(z_up, 0, 0)[1], 1, 1e-12);
  EXPECT_NEAR(sky_direction(z_up, 0, 90)[0], 1, 1e-12);
  EXPECT_NEAR(sky_direction(z_up, 90, 0)[2], 1, 1e-12);
}

// CIE's clear sky: darkest at some 90 degrees from the sun, brighter at the horizon than above it.
TEST(Sky, AClearOneIsBrightestAboutTheSun) {
  const Vec3d sun{std::sqrt(0.5), 0, std::sqrt(0.5)};
  const SkyModel clear = clear_sky({1, 1, 1}, sun);
  EXPECT_NEAR(clear({0, 0, 1})[0], 1, 1e-12);
  EXPECT_GT(clear(sun)[0], 3);
  EXPECT_LT(clear({-std::sqrt(0.5), 0, std::sqrt(0.5)})[0], 0.7);
  EXPECT_EQ(clear({0, 0, -1})[0], 0);
}

// Preetham's zenith at turbidity 2 and the sun 45 degrees high: (4.0453 T - 4.971) tan((4/9 - T/120) pi/2) - 0.2155 T +
// 2.4192 = 4.418 kcd/m^2; bluer away from the sun than about it.
TEST(Sky, PreethamsHasHisZenith) {
  const Vec3d sun{std::sqrt(0.5), 0, std::sqrt(0.5)};
  const SkyModel model = preetham_sky(2, sun);
  const double chi = (4.0 / 9 - 2.0 / 120) * kPi / 2;
  const double expected = 1000 * ((4.0453 * 2 - 4.971) * std::tan(chi) - 0.2155 * 2 + 2.4192) / kLumenPerWatt;
  EXPECT_NEAR(luminance(model({0, 0, 1})), expected, 1e-6 * expected);
  const Vec3d away = model({-std::sqrt(0.5), 0, std::sqrt(0.5)});
  const Vec3d about = model(sun);
  EXPECT_GT(away[2], 1.5 * away[0]) << "blue";
  EXPECT_LT(about[2] / about[0], away[2] / away[0]);
  EXPECT_GT(luminance(about), 3 * luminance(away));
}

// A lamp of one pixel among black ones: not a bit of its light is lost, though a cell is larger; its middle is north
// and a quarter to the right is east.
TEST(Sky, APicturesLightIsAllThere) {
  Picture picture{256, 128, {}};
  picture.pixels.resize(std::size_t{256} * 128);
  const std::uint32_t row = 40;
  picture.pixels[row * 256 + 192] = {1000, 500, 250};
  Sky sky = sky_of("radiance = 1\n");
  sky.radiance = sky_image_table(picture, {1, 2, 4});
  const double elevation = (0.5 - (row + 0.5) / 128) * kPi;
  const double solid_angle = 2 * kPi / 256 * 2 * std::sin(kPi / 256) * std::cos(elevation);
  const Vec3d sum = sky_from_everywhere(sky);
  EXPECT_NEAR(sum[0], 1000 * solid_angle, 1e-9);
  EXPECT_NEAR(sum[1], sum[0], 1e-9);
  EXPECT_NEAR(sum[2], sum[0], 1e-9);
  const Vec3d towards = sky_direction(sky, elevation * 180 / kPi, 90 + 360 * 0.5 / 256);
  EXPECT_NEAR(sky_irradiance(sky, towards)[0], sum[0], 5e-3 * sum[0]) << "all of it from there: a cell is 5 degrees";
}

TEST(Sky, APictureOfOneColourIsTheUniformSky) {
  for (const auto& [width, height] : {std::pair{1U, 1U}, {3U, 2U}, {2000U, 1000U}}) {
    Picture picture{width, height, {}};
    picture.pixels.assign(std::size_t{width} * height, {1, 2, 3});
    for (const Vec3d& radiance : sky_image_table(picture, {1, 1, 1})) {
      ASSERT_NEAR(radiance[0], 1, 1e-9);
      ASSERT_NEAR(radiance[2], 3, 1e-9);
    }
  }
}

/// A scene.toml with a sky of this table, and the files beside it.
Sky sky_with_files(const std::string& table, const std::map<std::string, std::string>& others) {
  std::map<std::string, std::string> files{{"s/scene.toml", "[room]\nsize = [1, 1, 1]\n[sky]\n" + table}};
  for (const auto& [name, text] : others) files["s/" + name] = text;
  MemoryFiles memory(files);
  return load_scene_from(memory, "s/scene.toml", {}).sky.value();
}

TEST(Sky, APictureIsReadFromBesideTheScene) {
  const Picture picture{2, 1, {{1, 1, 1}, {3, 3, 3}}};
  const auto text = [](const std::vector<std::byte>& bytes) {
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  for (const auto& [name, bytes] :
       {std::pair{std::string("day.exr"), encode_exr(picture)}, {std::string("day.pfm"), encode_pfm(picture)}}) {
    const Sky sky = sky_with_files("model = \"image\"\nfile = \"" + name + "\"\nscale = 2\n", {{name, text(bytes)}});
    EXPECT_NEAR(sky_irradiance(sky, sky.east)[0], 6 * kPi, 0.02 * kPi) << "its right half is the east";
    EXPECT_NEAR(sky_irradiance(sky, vec::scale(sky.east, -1))[0], 2 * kPi, 0.02 * kPi);
  }
  const auto refused = [&](const std::string& table, const std::map<std::string, std::string>& files) {
    try {
      sky_with_files(table, files);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto names = [](const std::string& message, const char* what) {
    return message.find(what) != std::string::npos;
  };
  EXPECT_TRUE(names(refused("model = \"image\"\n", {}), "file"));
  EXPECT_TRUE(names(refused("model = \"image\"\nfile = \"no.exr\"\n", {}), "no.exr"));
  EXPECT_TRUE(names(refused("model = \"image\"\nfile = \"day.hdr\"\n", {{"day.hdr", ""}}), ".exr"));
  EXPECT_TRUE(names(refused("model = \"image\"\nfile = \"a.exr\"\nground = 0.1\n", {}), "ground"));
  EXPECT_TRUE(names(refused("model = \"image\"\nfile = \"a.exr\"\n", {{"a.exr", "no picture"}}), "a.exr"));
  const Picture black{2, 1, {{0, 0, 0}, {-1, 0, 0}}};
  EXPECT_TRUE(names(refused("model = \"image\"\nfile = \"a.exr\"\n", {{"a.exr", text(encode_exr(black))}}), "black"));
}

// Of half floats, a sun that is too bright for them is infinite.
TEST(Sky, OddPixelsOfAPictureAreTold) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  const Picture picture{3, 1, {{1, 1, inf}, {-2, 1, 1}, {1, 1, 1}}};
  const std::vector<std::byte> bytes = encode_pfm(picture);
  MemoryFiles memory({{"s/scene.toml", "[room]\nsize = [1, 1, 1]\n[sky]\nmodel = \"image\"\nfile = \"a.pfm\"\n"},
                      {"s/a.pfm", {reinterpret_cast<const char*>(bytes.data()), bytes.size()}}});
  const Scene scene = load_scene_from(memory, "s/scene.toml", {});
  EXPECT_THAT(scene.warnings, testing::Contains(testing::HasSubstr("has 1 pixels that are infinite")));
  EXPECT_THAT(scene.warnings, testing::Contains(testing::HasSubstr("has 1 pixels below 0 or no number")));
  EXPECT_GT(sky_from_everywhere(scene.sky.value())[2], 65504) << "and it shines";
}

TEST(Sky, OpeningsAreRectangles) {
  const Sky sky = sky_of("radiance = 1\n[[sky.opening]]\ncorner = [1, 0, 0]\nedges = [[0, 0, 2], [0, 3, 0]]\n");
  ASSERT_EQ(sky.openings.size(), 1U);
  EXPECT_EQ(sky.openings[0].along, (Vec3d{0, 0, 2}));
  EXPECT_EQ(sky.openings[0].across, (Vec3d{0, 3, 0}));
}

void expect_refused(const std::string& table, const std::string& why) {
  try {
    sky_of(table);
    ADD_FAILURE() << table;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find("scene.toml:"), 0U) << error.what();
  }
}

TEST(Sky, WhatItMayNotSayIsRefused) {
  expect_refused("", "no light");
  expect_refused("radiance = -1\n", "radiance");
  expect_refused("model = \"overcst\"\n", "overcast");
  expect_refused("model = \"overcast\"\n", "zenith");
  expect_refused("model = \"preetham\"\n", "[sky.sun]");
  expect_refused("model = \"clear\"\nzenith = 1\n[sky.sun]\nelevation = -5\nazimuth = 0\nirradiance = 1\n", "above 0");
  expect_refused("radiance = 1\nup = [0, 0, 0]\n", "up");
  expect_refused("radiance = 1\nnorth = [0, 2, 0]\n", "north");
  expect_refused("radiance = 1\ncolour = 1\n", "colour");
  expect_refused("radiance = 1\n[sky.sun]\nelevation = 5\n", "azimuth");
}

TEST(Sky, OneSunShines) {
  Notices notices;
  std::optional<Sky> sky;
  take_suns({{{0, 2, 0}, {3, 2, 1}, {"a.gltf", 0}}, {{1, 0, 0}, {1, 1, 1}, {"a.gltf", 0}}}, sky, notices);
  ASSERT_TRUE(sky);
  EXPECT_EQ(sky->sun, (Vec3d{0, 1, 0}));
  EXPECT_EQ(sky->sun_irradiance, (Vec3d{3, 2, 1}));
  EXPECT_EQ(notices.lines().size(), 1U);
}

}  // namespace
}  // namespace torolux
