// SPDX-License-Identifier: MIT
// Closed rooms and rays in them: a room, a grid and a seed in; a failed test where a ray escapes, or where it hits
// another polygon than a search of all polygons without subspaces finds.
#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "firmware/pe/intersect.hpp"
#include "firmware/pe/traverse.hpp"
#include "tests/unit/firmware/pe/test_stores.hpp"

namespace torolux::test {

/// Half of the rays go to edges and vertices of polygons, half anywhere.
class Aim {
 public:
  Aim(const TestScene& scene, std::uint32_t seed) : scene_(scene), random_(seed) {}

  pe::Segment from(const glm::vec3& origin) {
    glm::vec3 target = uniform_point();
    if (random_() % 2 == 0) {
      const TestPolygon& polygon = scene_.polygons[random_() % scene_.polygons.size()];
      const std::size_t a = random_() % 3;
      const float s = random_() % 2 == 0 ? 0.0F : uniform();
      target = pe::to_vector(polygon.corner[a]) * (1.0F - s) + pe::to_vector(polygon.corner[(a + 1) % 3]) * s;
    }
    glm::vec3 direction = target - origin;
    if (random_() % 16 == 0) direction[static_cast<int>(random_() % 3)] = 0.0F;
    if (glm::dot(direction, direction) < 1e-12F) direction = {1, 0, 0};
    pe::Segment s{origin, glm::normalize(direction), 0, protocol::kNoPolygon, true, 0};
    s.place = scene_.place_of(s.origin);
    return s;
  }
  float uniform() { return static_cast<float>(random_() >> 8U) * 0x1p-24F; }
  glm::vec3 uniform_point() {
    return {uniform() * scene_.size[0], uniform() * scene_.size[1], uniform() * scene_.size[2]};
  }
  std::uint32_t number() { return static_cast<std::uint32_t>(random_()); }

 private:
  const TestScene& scene_;
  std::mt19937 random_;
};

struct Found {
  std::uint32_t polygon = protocol::kNoPolygon;
  float t = std::numeric_limits<float>::infinity();
};

inline Found brute_force(const pe::Scene& scene, const pe::Segment& s) {
  Found best;
  const pe::Shear shear(s.origin, s.direction, pe::Inverse(s.direction));
  for (const protocol::Polygon& p : scene.polygons) {
    pe::Crossing c;
    if (pe::cross_triangle(shear, p, c) && c.t > 0.0F && c.t < best.t) best = {p.number, c.t};
  }
  return best;
}

/// Origins half a step inside the walls: t = 0 rules are tested elsewhere.
inline glm::vec3 origin_in(Aim& aim, const glm::vec3& low, const glm::vec3& high) {
  return low + (high - low) * (0.02F + 0.96F * (aim.uniform_point()));
}

struct Case {
  TestScene scene;
  glm::vec3 low, high;  ///< where rays start
  std::uint32_t rays;
};

inline void no_ray_escapes(Case& c, std::uint32_t seed) {
  std::vector<PeStores> stores = build_stores(c.scene, protocol::Stage::ray_tracing);
  const pe::Scene scene = stores[0].scene();
  Aim aim(c.scene, seed);
  for (std::uint32_t i = 0; i < c.rays; ++i) {
    const pe::Segment start = aim.from(origin_in(aim, c.low, c.high));
    pe::Segment s = start;
    const pe::Way way = pe::traverse(scene, s);
    ASSERT_EQ(way.end, pe::WayEnd::hit) << "ray " << i << " escaped";
    if (i % 16 == 0) {
      const Found all = brute_force(scene, start);
      ASSERT_EQ(scene.polygons[way.hit.polygon].number, all.polygon) << "ray " << i;
      ASSERT_EQ(way.hit.t, all.t) << "ray " << i;
    }
  }
}

inline Case room(std::uint32_t n, std::array<std::uint32_t, 3> cells, const protocol::Vec3f& size) {
  Case c{{}, {0, 0, 0}, {size[0], size[1], size[2]}, 50'000};
  c.scene.materials = {diffuse_material(0.5F)};
  c.scene.size = size;
  c.scene.cells = cells;
  add_room(c.scene, {0, 0, 0}, size, n, 0);
  return c;
}

}  // namespace torolux::test
