// SPDX-License-Identifier: MIT
// Proves that what is wound or placed wrongly is reported, and that sound scenes are left in peace.
#include "host_tools/scene/inspect.hpp"

#include "tests/unit/scene/scene_text.hpp"

namespace torolux {
namespace {

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
  EXPECT_THAT(inspected(box(0, 10, true, "wall") + lamp(10, true)),
              Contains(HasSubstr("have their front against another surface")));
  EXPECT_THAT(inspected("usemtl wall\nv 0 0 0\nv 10 0 0\nv 10 0 10\nv 0 0 10\nf 4 3 2 1\n" + lamp(5, true)),
              Contains(HasSubstr("look inverted")));
}

TEST(Inspect, SurfacesInOnePlane) {
  const std::string floor = "v 0 0 0\nv 4 0 0\nv 4 0 4\nv 0 0 4\nusemtl wall\nf -1 -2 -3 -4\n";
  const std::string rug = "v 1 0 1\nv 2 0 1\nv 2 0 2\nv 1 0 2\nusemtl other\nf -1 -2 -3 -4\n";
  const std::string beside = "v 4 0 0\nv 6 0 0\nv 6 0 4\nv 4 0 4\nusemtl other\nf -1 -2 -3 -4\n";
  EXPECT_THAT(inspected(floor + rug), Contains(HasSubstr("'wall' and 'other' overlap in one plane")));
  EXPECT_THAT(inspected(floor + beside), IsEmpty()) << "a common edge is no overlap";
}

}  // namespace
}  // namespace torolux
