// SPDX-License-Identifier: MIT
// Sides: left out exactly where no light can reach them for certain.
#include "host_tools/mesh/lit_sides.hpp"

#include <gtest/gtest.h>

#include "firmware/protocol/stores.hpp"
#include "host_tools/mesh/mesh.hpp"
#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux {
namespace {

using protocol::kBackPresent;
using protocol::kFrontPresent;
constexpr std::uint8_t kBoth = kFrontPresent | kBackPresent;

/// Sides of each triangle of the scene.
std::vector<int> sides_of(const Scene& scene, bool two_sided = false) {
  std::vector<int> sides;
  for (const MeshTriangle& triangle : make_mesh(scene, {.two_sided_lights = two_sided}).triangles) {
    sides.push_back(triangle.sides);
  }
  return sides;
}

std::vector<int> repeat(int value, std::size_t times) {
  return std::vector<int>(times, value);
}

TEST(Sides, RoomShowsItsInsideAndBoxItsOutside) {
  const std::vector<int> sides = sides_of(test::room_with_box());
  // The room's fronts look inwards, the lamp keeps both, the box's fronts look outwards.
  std::vector<int> expected = repeat(kFrontPresent, 12);
  expected.insert(expected.end(), 2, kBoth);
  expected.insert(expected.end(), 12, kFrontPresent);
  EXPECT_EQ(sides, expected);
}

TEST(Sides, WindingTellsWhichSideIsInside) {
  test::SceneBuilder builder;
  builder.box(builder.material({0.5, 0.5, 0.5}), {0, 0, 0}, {1, 1, 1}, false);  // fronts outwards: a room inside out
  builder.quad(builder.material({0, 0, 0}, {1, 1, 1}), {0.4, 0.5, 0.4}, {0.6, 0.5, 0.4}, {0.6, 0.5, 0.6},
               {0.4, 0.5, 0.6});
  std::vector<int> expected = repeat(kBackPresent, 12);
  expected.insert(expected.end(), 2, kBoth);
  EXPECT_EQ(sides_of(builder.scene), expected);
}

TEST(Sides, EmittersOnBothSidesKeepBoth) {
  Scene scene = test::room_with_box();
  test::SceneBuilder builder{.scene = scene};
  builder.quad(1, {3, 0, 0}, {3, 1, 0}, {3, 1, 1}, {3, 0, 1});  // a second lamp outside the room
  const std::vector<int> sides = sides_of(builder.scene);
  EXPECT_EQ(std::vector<int>(sides.begin(), sides.begin() + 12), repeat(kBoth, 12));
  EXPECT_EQ(std::vector<int>(sides.begin() + 14, sides.begin() + 26), repeat(kFrontPresent, 12));
}

TEST(Sides, LampThatTouchesAWallKeepsBoth) {
  test::SceneBuilder builder;
  builder.box(builder.material({0.5, 0.5, 0.5}), {0, 0, 0}, {1, 1, 1}, true);
  builder.quad(builder.material({0, 0, 0}, {1, 1, 1}), {0.4, 1, 0.4}, {0.6, 1, 0.4}, {0.6, 1, 0.6}, {0.4, 1, 0.6});
  EXPECT_EQ(sides_of(builder.scene), repeat(kBoth, 14));
}

TEST(Sides, GlassInTheShellKeepsBoth) {
  Scene scene = test::room_with_box();
  test::SceneBuilder builder{.scene = scene};
  builder.scene.triangles[14].material = builder.glass();  // one half of a face of the box
  const std::vector<int> sides = sides_of(builder.scene);
  EXPECT_EQ(sides[14], 0);
  EXPECT_EQ(std::vector<int>(sides.begin() + 15, sides.end()), repeat(kBoth, 11));
}

TEST(Sides, OpenShellKeepsBoth) {
  Scene scene = test::room_with_box();
  scene.triangles.pop_back();
  const std::vector<int> sides = sides_of(scene);
  EXPECT_EQ(std::vector<int>(sides.begin() + 14, sides.end()), repeat(kBoth, 11));
}

TEST(Sides, ShellThatCrossesItselfKeepsBoth) {
  // A box whose upper face is pushed down through the lower one: closed and wound alike, but inside out below.
  Scene scene = test::room_with_box();
  for (Vec3d& position : scene.positions) {
    if (position == Vec3d{0.2, 0.5, 0.2}) position = {0.3, 0.05, 0.3};
  }
  const std::vector<int> sides = sides_of(scene);
  EXPECT_EQ(std::vector<int>(sides.begin() + 14, sides.end()), repeat(kBoth, 12));
}

TEST(Sides, ClosedEmitterLightsWhereItsFrontsLook) {
  test::SceneBuilder builder;
  builder.box(builder.material({0.5, 0.5, 0.5}, {1, 1, 1}), {0, 0, 0}, {1, 1, 1}, true);
  EXPECT_EQ(sides_of(builder.scene), repeat(kFrontPresent, 12));
  EXPECT_EQ(sides_of(builder.scene, true), repeat(kBoth, 12));
}

}  // namespace
}  // namespace torolux
