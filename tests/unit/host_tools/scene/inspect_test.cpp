// SPDX-License-Identifier: MIT
// Proves that what is wound or placed wrongly is reported, and that sound scenes are left in peace.
#include "host_tools/scene/inspect.hpp"

#include "host_tools/scene/dark_view.hpp"
#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// A box, fronts outwards; `before` and `size` move and scale it.
std::string box(double low, double high, bool inwards, const std::string& material) {
  const std::string l = std::to_string(low);
  const std::string h = std::to_string(high);
  std::string text = "usemtl " + material + "\n";
  for (int i = 0; i < 8; ++i)
    text += "v " + ((i & 1) != 0 ? h : l) + " " + ((i & 2) != 0 ? h : l) + " " + ((i & 4) != 0 ? h : l) + "\n";
  text += inwards ? "f -8 -7 -5 -6\nf -4 -2 -1 -3\nf -8 -4 -3 -7\nf -6 -5 -1 -2\nf -8 -6 -2 -4\nf -7 -3 -1 -5\n"
                  : "f -6 -5 -7 -8\nf -3 -1 -2 -4\nf -7 -3 -4 -8\nf -2 -1 -5 -6\nf -4 -2 -6 -8\nf -5 -1 -3 -7\n";
  return text;
}

std::vector<std::string> inspected(const std::string& obj) {
  return inspect(
      load_texts({{"a.obj", "mtllib a.mtl\n" + obj},
                  {"a.mtl",
                   "newmtl wall\nKd 0.5 0.5 0.5\nnewmtl other\nKd 0.2 0.2 0.2\nnewmtl glass\nillum 7\nNi 1.5\n"
                   "newmtl lamp\nKd 0 0 0\nKe 1 1 1\n"}},
                 "a.obj"));
}

/// A square in the plane y = height, facing down.
std::string lamp(double height, bool up = false) {
  std::string text = "usemtl lamp\n";
  for (const char* xz : {"4 4", "6 4", "6 6", "4 6"})
    text += std::string("v ") + xz[0] + " " + std::to_string(height) + " " + xz[2] + "\n";
  return text + (up ? "f -1 -2 -3 -4\n" : "f -4 -3 -2 -1\n");
}

TEST(Inspect, SoundSceneIsLeftInPeace) {
  EXPECT_THAT(inspected(box(0, 10, true, "wall") + box(2, 3, false, "wall") + box(7, 8, false, "glass") + lamp(9.9)),
              IsEmpty());
}

TEST(Inspect, AnOpeningOfTheSkyThatFacesOutwards) {
  const auto of = [](const std::string& facing) {
    return inspect(load_texts({{"s.toml",
                                "[room]\nsize = [4, 3, 5]\nopen = ['front']\n[sky]\nradiance = 1\n[[sky.opening]]\n"
                                "centre = [2, 1.5, 5]\nsize = [4, 3]\nfacing = " +
                                    facing + "\n"}},
                              "s.toml"));
  };
  EXPECT_THAT(of("[0, 0, -1]"), IsEmpty());
  EXPECT_THAT(of("[0, 0, 1]"), Contains(HasSubstr("[[sky.opening]] 1 around 2,1.5,5 faces outwards")));
}

TEST(Inspect, InvertedSolidAndRoom) {
  EXPECT_THAT(inspected(box(0, 10, true, "wall") + box(2, 3, true, "wall")),
              Contains(HasSubstr("closed solid 'wall' around 2.5,2.5,2.5 has its fronts inwards")));
  EXPECT_THAT(inspected(box(0, 10, false, "wall") + box(2, 3, false, "wall")),
              Contains(HasSubstr("closed room 'wall' around 5,5,5 has its fronts outwards")));
}

TEST(Inspect, GlassInsideOutOrOpen) {
  EXPECT_THAT(inspected(box(0, 10, true, "wall") + box(2, 3, true, "glass")), Contains(HasSubstr("is inside out")));
  EXPECT_THAT(inspected(box(0, 10, true, "wall") + "usemtl glass\nv 1 1 1\nv 2 1 1\nv 2 2 1\nf -3 -2 -1\n"),
              Contains(HasSubstr("is open")));
  // A bubble: the inner surface of hollow glass faces the hollow.
  EXPECT_THAT(inspected(box(0, 10, true, "wall") + box(2, 5, false, "glass") + box(3, 4, true, "glass")), IsEmpty());
}

TEST(Inspect, EmittersAgainstAWallOrFacingAway) {
  EXPECT_THAT(inspected(box(0, 10, true, "wall") + lamp(9.99995, true)),
              Contains(HasSubstr("have their front against another surface")));
  EXPECT_THAT(inspected("usemtl wall\nv 0 0 0\nv 10 0 0\nv 10 0 10\nv 0 0 10\nf 4 3 2 1\n" + lamp(5, true)),
              Contains(HasSubstr("look inverted")));
  EXPECT_THAT(inspected("usemtl wall\nv 0 0 0\nv 10 0 0\nv 10 0 10\nv 0 0 10\nf 4 3 2 1\n" + box(4, 5, false, "lamp")),
              IsEmpty())
      << "a bulb in the open";
  EXPECT_THAT(inspected(box(0, 10, true, "wall") + lamp(9.8, true)),
              Contains(HasSubstr("face a surface close before them")));
  EXPECT_THAT(inspected(box(0, 10, true, "wall") + lamp(9, true)), IsEmpty()) << "an uplight";
  EXPECT_THAT(inspected(box(0, 10, true, "wall") + box(9.7, 9.8, false, "lamp")), IsEmpty()) << "on all sides";
}

TEST(Inspect, EmittersTooSmallForTheirScene) {
  const std::string room = box(0, 10, true, "wall");
  const auto square = [](const char* from, const char* to) {
    std::string text = "usemtl lamp\n";
    for (const auto& [x, z] : {std::pair{from, from}, {to, from}, {to, to}, {from, to}})
      text += std::string("v ") + x + " 7 " + z + "\n";
    return text + "f -4 -3 -2 -1\n";
  };
  EXPECT_THAT(inspected(room + box(4, 4.0002, false, "lamp") + square("2", "2.0001")), IsEmpty());
  // 1/200,000 of the scene and 1/100,000 of a body's size: below, a tenth of the light is lost.
  EXPECT_THAT(inspected(room + square("2", "2.00004")),
              testing::ElementsAre("emitter 'lamp' around 2.00002,7,2.00002 is 4e-05 across, too small for its scene: "
                                   "of less than 5e-05, 1/200,000 of it, light is lost, for rays in single precision "
                                   "pass by; make it larger and its emission less, or the scene smaller"));
  EXPECT_THAT(inspected(room + box(4, 4.00006, false, "lamp") + box(5, 5.00005, false, "lamp") +
                        box(6, 6.00007, false, "lamp") + box(7, 7.00006, false, "wall")),
              testing::ElementsAre(AllOf(HasSubstr("emitter 'lamp' around 5.00002,5.00002,5.00002 is 5e-05 across"),
                                         HasSubstr("less than 0.0001, 1/100,000 of it"), HasSubstr("(and 2 more)"))));
}

TEST(Inspect, ASceneWhoseOnlyEmitterHasNoAreaSaysWhyItHasNoLight) {
  const auto refused = [] {
    check_renderable(load_texts({{"a.obj",
                                  "mtllib a.mtl\nv 0 0 0\nv 9 0 0\nv 9 0 9\nf 3 2 1\nusemtl lamp\n"
                                  "v 2 7 2\nv 2.0000001 7 2\nv 2.0000001 7 2.0000001\nf 4 5 6\n"},
                                 {"a.mtl", "newmtl lamp\nKd 0 0 0\nKe 1 1 1\n"}},
                                "a.obj"));
  };
  EXPECT_THAT(refused, testing::ThrowsMessage<InputError>(
                           AllOf(HasSubstr("has no light"),
                                 HasSubstr("a.obj:10: a triangle that emits is left out: against the scene it is too "
                                           "small for single precision: 'lamp'"))));
}

TEST(Inspect, SurfacesThatAreLeftInOnePlane) {
  const std::string floor = "v 0 0 0\nv 4 0 0\nv 4 0 4\nv 0 0 4\nusemtl wall\nf -1 -2 -3 -4\n";
  const std::string beside = "v 4 0 0\nv 6 0 0\nv 6 0 4\nv 4 0 4\nusemtl other\nf -1 -2 -3 -4\n";
  EXPECT_THAT(inspected(floor + box(0, 2, false, "glass")),
              Contains(AllOf(HasSubstr("'wall' and 'glass' overlap in one plane"), HasSubstr("move 'glass' away"))));
  EXPECT_THAT(inspected(floor + box(0, 2, false, "other")), IsEmpty()) << "nobody sees where it stands";
  EXPECT_THAT(inspected(floor + beside), IsEmpty()) << "a common edge is no overlap";
}

/// What is said of a view into a room of 10 x 10 x 10, fronts inwards, with `more` in it.
std::vector<std::string> viewed(const std::string& more, const Vec3d& eye, const Vec3d& look_at,
                                bool two_sided = false) {
  const Scene scene = load_texts({{"a.obj", "mtllib a.mtl\n" + box(0, 10, true, "wall") + more},
                                  {"a.mtl",
                                   "newmtl wall\nKd 0.5 0.5 0.5\nnewmtl black\nKd 0 0 0\nnewmtl glass\nillum 7\nNi "
                                   "1.5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n"}},
                                 "a.obj");
  return inspect_view(scene, {eye, look_at, {0, 1, 0}, 40}, 1.5, two_sided);
}

const Vec3d kInside{5, 5, 9};
const Vec3d kMiddle{5, 5, 5};

TEST(InspectView, WhatIsLitIsLeftInPeace) {
  EXPECT_THAT(viewed(lamp(9.9), kInside, kMiddle), IsEmpty());
  EXPECT_THAT(viewed(lamp(9.9) + box(8.5, 9.5, false, "glass"), {9, 9, 9}, kMiddle), IsEmpty()) << "through glass";
  EXPECT_THAT(viewed(lamp(5, true), {5, 1, 9}, {5, 0, 5}), IsEmpty()) << "by way of the ceiling";
}

TEST(InspectView, BlackPicturesSayWhy) {
  EXPECT_THAT(viewed(lamp(9.9), {5, 5, 30}, {5, 5, 40}), testing::ElementsAre(HasSubstr("sees nothing of the scene")));
  EXPECT_THAT(viewed(lamp(9.9), {5, 5, 30}, kMiddle),
              testing::ElementsAre(AllOf(HasSubstr("no light reaches"), HasSubstr("back sides only ('wall' most)"))));
  EXPECT_THAT(viewed(lamp(10.5), kInside, kMiddle), testing::ElementsAre(HasSubstr("'wall' stands between")));
  EXPECT_THAT(viewed(lamp(9.9) + box(4, 6, false, "wall"), kMiddle, {5, 5, 4.5}),
              testing::ElementsAre(HasSubstr("stands behind a wall or inside a solid")));
  EXPECT_THAT(viewed(lamp(9.9) + box(4.5, 9.5, true, "black"), kMiddle, {7, 7, 7}),
              testing::ElementsAre(HasSubstr("it reflects nothing ('black' most)")));
  // In the ceiling's plane, so that the ceiling is cut out around it, and facing out.
  EXPECT_THAT(viewed(lamp(10, true), kInside, kMiddle), testing::ElementsAre(HasSubstr("'lamp' turns its back on it")));
  // A shaft around the camera, and a lamp on its lid that faces out.
  const std::string away = box(4, 6, true, "wall") + lamp(5.9, true);
  EXPECT_THAT(viewed(away, kMiddle, {5, 4.5, 5.5}), testing::ElementsAre(HasSubstr("'lamp' turns its back on it")));
  EXPECT_THAT(viewed(away, kMiddle, {5, 4.5, 5.5}, true), IsEmpty());
}

}  // namespace
}  // namespace torolux
