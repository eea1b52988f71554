// SPDX-License-Identifier: MIT
// Proves: from inside a closed room no ray escapes, whatever the grid and wherever it is aimed, edges, vertices and
// walls in subspace planes included; and the hit is the one that a search of all polygons without subspaces finds.
#include <gtest/gtest.h>

#include "firmware/pe/specular.hpp"
#include "firmware/pe/surface.hpp"
#include "tests/unit/firmware/pe/closed_rooms.hpp"

namespace torolux::test {
namespace {

using pe::Segment;

// Ten grids, a hundred thousand rays each in two rooms: a million in all.
TEST(Watertight, NoRayEscapesFromARoomWhateverTheGrid) {
  const std::array<std::array<std::uint32_t, 3>, 10> grids = {{{1, 1, 1},
                                                               {2, 2, 2},
                                                               {3, 3, 3},
                                                               {4, 4, 4},
                                                               {5, 7, 3},
                                                               {8, 8, 8},
                                                               {1, 16, 1},
                                                               {7, 1, 11},
                                                               {13, 13, 13},
                                                               {32, 2, 9}}};
  std::uint32_t seed = 1;
  for (const auto& grid : grids) {
    Case even = room(4, grid, {1, 1, 1});
    no_ray_escapes(even, seed++);
    Case odd = room(3, grid, {1.0F, 0.71F, 0.37F});
    odd.scene.groups = true;  // of equally near polygons the one with the lowest number all the same
    no_ray_escapes(odd, seed++);
    if (HasFatalFailure()) FAIL() << "grid " << grid[0] << " " << grid[1] << " " << grid[2];
  }
}

// Inner walls in subspace planes: x = 0.25, 0.5 of a grid of eight.
TEST(Watertight, WallsInSubspacePlanesHold) {
  Case c{{}, {0.25F, 0.25F, 0.5F}, {0.5F, 0.75F, 0.75F}, 100'000};
  c.scene.materials = {diffuse_material(0.5F)};
  c.scene.cells = {8, 8, 8};
  add_room(c.scene, {0.25F, 0.25F, 0.5F}, {0.5F, 0.75F, 0.75F}, 3, 0);
  no_ray_escapes(c, 77);
}

TEST(Watertight, NoRayEscapesFromABall) {
  for (const std::uint32_t g : {1U, 4U, 9U}) {
    Case c{{}, {0.3F, 0.3F, 0.3F}, {0.7F, 0.7F, 0.7F}, 40'000};
    c.scene.materials = {diffuse_material(0.5F)};
    c.scene.cells = {g, g, g};
    c.scene.groups = g != 4;
    add_ball(c.scene, {0.5F, 0.5F, 0.5F}, 0.5F, 12, 0, false);
    no_ray_escapes(c, g);
  }
}

/// A ray's way over all PEs, through the record, as on the torus. hand_overs: added to.
pe::Way follow(const std::vector<pe::Scene>& scenes, const TestScene& many, const Segment& start, std::uint16_t& at,
               std::uint32_t& hand_overs) {
  const auto cell = many.cell_of({start.origin.x, start.origin.y, start.origin.z});
  at = many.pe_of(cell[0], cell[1], cell[2]);
  protocol::RayRecord record{};
  record.origin = pe::to_array(start.origin);
  record.direction = pe::to_array(start.direction);
  record.place = start.place;
  record.polygon = start.polygon;
  record.flags = protocol::kFirst;
  for (;;) {
    Segment segment = pe::segment_of(record);
    const pe::Way way = pe::traverse(scenes[at], segment);
    pe::note_progress(record, segment);
    if (way.end != pe::WayEnd::handed_on) return way;
    at = way.next;
    ++hand_overs;
  }
}

// Every hand-over between PEs leaves the ray's hit as it was, bit for bit; so does stepping over what is empty, and who
// holds copies of what. Fewer stops, fewer hand-overs; with copies of all there are none.
TEST(Watertight, HandOverChangesNothing) {
  Case one = room(4, {5, 6, 7}, {1, 1, 1});
  add_ball(one.scene, {0.5F, 0.4F, 0.6F}, 0.2F, 8, 0, true);
  std::vector<PeStores> single = build_stores(one.scene, protocol::Stage::ray_tracing);
  const pe::Scene alone = single[0].scene();
  std::vector<std::uint32_t> hand_overs;
  for (const auto& [stop_everywhere, copy_all] :
       {std::pair{true, false}, {false, false}, {true, true}, {false, true}}) {
    TestScene many = one.scene;
    many.pes = 6;
    many.stop_everywhere = stop_everywhere;
    many.copy_all = copy_all;
    std::vector<PeStores> spread = build_stores(many, protocol::Stage::ray_tracing);
    std::vector<pe::Scene> scenes;
    for (PeStores& s : spread) scenes.push_back(s.scene());
    Aim aim(one.scene, 5);
    hand_overs.push_back(0);
    for (std::uint32_t i = 0; i < 30'000; ++i) {
      const Segment start = aim.from(origin_in(aim, one.low, one.high));
      Segment a = start;
      const pe::Way expected = pe::traverse(alone, a);
      std::uint16_t at = 0;
      const pe::Way way = follow(scenes, many, start, at, hand_overs.back());
      ASSERT_EQ(way.end, expected.end);
      ASSERT_EQ(scenes[at].polygons[way.hit.polygon].number, alone.polygons[expected.hit.polygon].number);
      ASSERT_EQ(way.hit.t, expected.hit.t);
      ASSERT_EQ(way.hit.b1, expected.hit.b1);
      ASSERT_EQ(way.hit.b2, expected.hit.b2);
      ASSERT_EQ(way.hit.front, expected.hit.front);
    }
  }
  EXPECT_GT(hand_overs[0], 60'000U);
  EXPECT_GT(hand_overs[1], 30'000U);
  EXPECT_LT(hand_overs[1], 9 * (hand_overs[0] / 10)) << "inside the room most cells are empty";
  EXPECT_EQ(hand_overs[2], 0U);
  EXPECT_EQ(hand_overs[3], 0U);
}

// From outside, through the outer faces, in which the walls lie: each ray meets the room.
TEST(Watertight, RaysFromOutsideMeetWallsInTheOuterFaces) {
  for (const std::uint32_t g : {1U, 3U, 8U}) {
    Case c = room(3, {g, g, g}, {1, 1, 1});
    std::vector<PeStores> stores = build_stores(c.scene, protocol::Stage::ray_tracing);
    const pe::Scene scene = stores[0].scene();
    Aim aim(c.scene, g);
    for (std::uint32_t i = 0; i < 50'000; ++i) {
      const glm::vec3 origin{-0.3F - aim.uniform(), aim.uniform(), aim.uniform()};
      const glm::vec3 target{0.0F, 0.01F + 0.98F * aim.uniform(), 0.01F + 0.98F * aim.uniform()};
      Segment s{origin, glm::normalize(target - origin), 0, protocol::kNoPolygon, false, 0};
      s.place = c.scene.place_of({0, target.y, target.z});
      const pe::Way way = pe::traverse(scene, s);
      ASSERT_EQ(way.end, pe::WayEnd::hit) << "ray " << i;
      ASSERT_LT(std::abs((origin + s.direction * way.hit.t).x), 1e-6F) << "ray " << i << " went through the first wall";
    }
  }
}

// Rays that leave a wall close to an edge or corner, from a point that rounding put behind the neighbouring wall, meet
// that wall all the same.
TEST(Watertight, RoundedOriginsBehindTheNextWallDoNotLeak) {
  for (const std::uint32_t g : {1U, 4U, 7U}) {
    Case c = room(2, {g, g, g}, {1, 1, 1});
    std::vector<PeStores> stores = build_stores(c.scene, protocol::Stage::ray_tracing);
    const pe::Scene scene = stores[0].scene();
    Aim aim(c.scene, g);
    std::uint32_t behind = 0;
    for (std::uint32_t i = 0; i < 100'000; ++i) {
      // Near the wall y = 0, within some 1e-7 of the wall x = 1, on either side of it.
      const float off = (aim.uniform() - 0.5F) * 0x1p-21F;
      const glm::vec3 origin{1.0F + off, 0x1p-16F, 0.02F + 0.96F * aim.uniform()};
      behind += origin.x > 1.0F ? 1U : 0U;
      const glm::vec3 direction =
          glm::normalize(glm::vec3{0.05F + aim.uniform(), 0.02F + aim.uniform(), aim.uniform() - 0.5F});
      Segment s{origin, direction, 0, protocol::kNoPolygon, true, 0};
      s.place = c.scene.place_of(origin);
      const pe::Way way = pe::traverse(scene, s);
      ASSERT_EQ(way.end, pe::WayEnd::hit) << "off " << off;
      ASSERT_TRUE(way.hit.front);
    }
    EXPECT_GT(behind, 10'000U);
  }
}

// A room of mirrors, rays aimed at edges and vertices: each is reflected eight times and none gets out.
TEST(Watertight, NoRayEscapesFromARoomOfMirrors) {
  for (const std::uint32_t g : {1U, 4U, 9U}) {
    Case c = room(3, {g, g, g}, {1.0F, 0.71F, 0.37F});
    std::vector<PeStores> stores = build_stores(c.scene, protocol::Stage::ray_tracing);
    const pe::Scene scene = stores[0].scene();
    Aim aim(c.scene, g);
    for (std::uint32_t i = 0; i < 30'000; ++i) {
      Segment s = aim.from(origin_in(aim, c.low, c.high));
      for (std::uint32_t bounce = 0; bounce < 8; ++bounce) {
        const pe::Way way = pe::traverse(scene, s);
        ASSERT_EQ(way.end, pe::WayEnd::hit) << "ray " << i << " bounce " << bounce;
        ASSERT_TRUE(way.hit.front) << "ray " << i << " bounce " << bounce;
        const protocol::Polygon& polygon = scene.polygons[way.hit.polygon];
        const glm::vec3 n = pe::unit_normal(polygon);
        s.origin = pe::leaving_point(polygon, s.origin + s.direction * way.hit.t);
        s.direction = pe::reflect(s.direction, n, n);
        s.polygon = polygon.number;
        s.first = true;
      }
    }
  }
}

// A point covered by a coincident polygon that faces it is blocked.
TEST(Watertight, CoincidentOppositePolygonBlocks) {
  Case c{{}, {0, 0, 0}, {1, 1, 1}, 0};
  c.scene.materials = {diffuse_material(0.5F)};
  add_wall(c.scene, {0, 0, 0.5F}, {1, 0, 0}, {0, 1, 0}, 1, 0);  // polygons 0, 1: front +z
  add_wall(c.scene, {0, 0, 0.5F}, {0, 1, 0}, {1, 0, 0}, 1, 0);  // polygons 2, 3: front -z, the same place
  std::vector<PeStores> stores = build_stores(c.scene, protocol::Stage::ray_tracing);
  const pe::Scene scene = stores[0].scene();
  Segment s{{0.7F, 0.3F, 0.5F}, glm::normalize(glm::vec3{0.1F, 0.2F, 1.0F}), 0, 0, true, 0};
  const pe::Way way = pe::traverse(scene, s);
  ASSERT_EQ(way.end, pe::WayEnd::hit);
  EXPECT_GE(scene.polygons[way.hit.polygon].number, 2U);
}

}  // namespace
}  // namespace torolux::test
