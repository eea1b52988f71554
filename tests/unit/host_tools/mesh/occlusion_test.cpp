// SPDX-License-Identifier: MIT
// What occluders hide: the floor under them, if they are opaque, let no light in and hold no lamp; elements that reach
// under them send from beside.
#include "host_tools/mesh/occlusion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "host_tools/mesh/mesh.hpp"
#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux {
namespace {

constexpr Vec3d kMiddle{0.47, 0, 0.53};  ///< of the block

/// A corner of the block, turned by some 20 degrees; corner: 0..3.
Vec3d foot(int corner, double height) {
  const double angle = 0.35 + 0.5 * 3.14159265358979 * corner;
  return {kMiddle[0] + 0.2 * std::cos(angle), height, kMiddle[2] - 0.2 * std::sin(angle)};
}

enum class Block : std::uint8_t { whole, with_bottom, without_a_side, with_lamp, of_glass };

/// A floor of edge 1, a lamp high above, a block.
Scene floor_with(Block block) {
  test::SceneBuilder builder;
  const std::uint32_t white = builder.material({0.5, 0.5, 0.5});
  const std::uint32_t lamp = builder.material({0, 0, 0}, {1, 1, 1});
  const std::uint32_t of = block == Block::of_glass ? builder.glass() : white;
  builder.quad(white, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0});
  builder.triangle(lamp, {0, 3, 0}, {1, 3, 0}, {1, 3, 1});
  for (int side = block == Block::without_a_side ? 1 : 0; side < 4; ++side) {
    const int next = (side + 1) % 4;
    builder.quad(of, foot(side, 0), foot(next, 0), foot(next, 0.3), foot(side, 0.3));
  }
  builder.quad(of, foot(0, 0.3), foot(1, 0.3), foot(2, 0.3), foot(3, 0.3));
  if (block == Block::with_bottom) builder.quad(of, foot(3, 0), foot(2, 0), foot(1, 0), foot(0, 0));
  if (block == Block::with_lamp) builder.triangle(lamp, {.45, .2, .45}, {.55, .2, .45}, {.5, .2, .55});
  return builder.scene;
}

Mesh mesh_of(Block block) {
  return make_mesh(floor_with(block), {.patch_length = 0.4, .element_length = 0.1});
}

/// Of the floor, whose first triangle has corners at (0, 0), (0, 1) and (1, 1), the second (0, 0), (1, 1) and (1, 0).
bool hides(const Mesh& mesh, double x, double z) {
  return z >= x ? mesh.occlusion.occludes(mesh, 0, 0, {z - x, x}) : mesh.occlusion.occludes(mesh, 1, 0, {z, x - z});
}

/// Inside the block's foot, grown by `more`.
bool in_foot(double x, double z, double more) {
  for (int side = 0; side < 4; ++side) {
    const Vec3d a = foot(side, 0);
    const Vec3d b = foot((side + 1) % 4, 0);
    const double length = std::hypot(b[0] - a[0], b[2] - a[2]);
    const double beside = ((b[2] - a[2]) * (x - a[0]) - (b[0] - a[0]) * (z - a[2])) / length;
    if (beside < -more) return false;
  }
  return true;
}

TEST(Occlusion, FloorUnderABlockAndNoMore) {
  for (const Block block : {Block::whole, Block::with_bottom}) {
    const Mesh mesh = mesh_of(block);
    int hidden = 0;
    for (double x = 0.005; x < 1; x += 0.0213) {
      for (double z = 0.005; z < 1; z += 0.0217) {
        if (in_foot(x, z, 0.001) != in_foot(x, z, -0.001)) continue;
        EXPECT_EQ(hides(mesh, x, z), in_foot(x, z, 0)) << x << " " << z;
        if (in_foot(x, z, 0)) ++hidden;
      }
    }
    EXPECT_GT(hidden, 100);
  }
}

TEST(Occlusion, NothingUnderWhatLightGetsInto) {
  for (const Block block : {Block::without_a_side, Block::with_lamp, Block::of_glass}) {
    const Mesh mesh = mesh_of(block);
    for (double x = 0.305; x < 0.7; x += 0.05) EXPECT_FALSE(hides(mesh, x, 0.53)) << static_cast<int>(block);
  }
}

TEST(Occlusion, ElementsAtTheFootSendFromBesideIt) {
  const Mesh mesh = mesh_of(Block::whole);
  int moved = 0;
  for (const MeshFacet& facet : mesh.facets) {
    const auto part = sending_part(mesh, facet);
    if (facet.triangle > 1 || !part || *part == facet.code) continue;
    ++moved;
    for (const Vec3d& corner : grid_corners(mesh.triangles[facet.triangle], *part)) {
      const double x = corner[0] / mesh.space.scale + mesh.space.origin[0];
      const double z = corner[2] / mesh.space.scale + mesh.space.origin[2];
      EXPECT_FALSE(in_foot(x, z, -0.001)) << x << " " << z;
    }
    // Still its own: the part is a descendant in the facet's grid.
    std::uint32_t above = *part;
    while (above > facet.code) above >>= 2U;
    EXPECT_EQ(above, facet.code);
  }
  EXPECT_GT(moved, 20);
  const Mesh open = mesh_of(Block::without_a_side);
  for (const MeshFacet& facet : open.facets) EXPECT_EQ(sending_part(open, facet), facet.code) << facet.triangle;
}

}  // namespace
}  // namespace torolux
