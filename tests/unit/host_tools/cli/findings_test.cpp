// SPDX-License-Identifier: MIT
// Proves: after a render, light that has left a closed surface and a black picture are told, and nothing else is.
#include "host_tools/cli/findings.hpp"

#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A unit cube, or one without its lid, whose floor emits.
Scene cube(bool closed) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0 1 0\nv 1 1 0\nv 1 1 1\nv 0 1 1\n";
  const std::string sides = "usemtl wall\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  return load_texts(
      {{"a.obj", "mtllib a.mtl\n" + points + sides + (closed ? "f 5 6 7 8\n" : "") + "usemtl lamp\nf 4 3 2 1\n"},
       {"a.mtl", "newmtl wall\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n"}},
      "a.obj");
}

RenderResult result(double escaped, float brightness) {
  RenderResult made;
  made.picture = {2, 1, {{0, 0, 0}, {0, 0, brightness}}};
  made.figures.energy.emitted = {2, 2, 2};
  made.figures.energy.escaped = {2 * escaped, 2 * escaped, 2 * escaped};
  return made;
}

TEST(Findings, LightThatLeavesAClosedSurfaceIsTold) {
  EXPECT_THAT(findings_after(cube(true), result(0.02, 1)),
              ElementsAre(HasSubstr("2 % of the light has left the scene")));
  EXPECT_THAT(findings_after(cube(true), result(0.0005, 1)), IsEmpty());
  EXPECT_THAT(findings_after(cube(false), result(0.02, 1)), IsEmpty()) << "it is open";
}

TEST(Findings, ABlackPictureIsTold) {
  EXPECT_THAT(findings_after(cube(true), result(0, 0)), ElementsAre(HasSubstr("on none that is seen")));
  EXPECT_THAT(findings_after(cube(false), result(0.9, 0)), ElementsAre(HasSubstr("lamps that face away?")));
  EXPECT_THAT(findings_after(cube(true), result(0, 1e-30F)), IsEmpty());
  EXPECT_THAT(findings_after(cube(true), RenderResult{}), IsEmpty()) << "--no-picture, or interrupted";
}

}  // namespace
}  // namespace torolux
