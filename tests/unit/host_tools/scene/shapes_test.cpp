// SPDX-License-Identifier: MIT
// Proves that curved shapes become closed triangle meshes of nearly the true area, with their fronts and normals
// outwards, or inwards where that is asked for.
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "host_tools/scene/shapes.hpp"

namespace torolux {
namespace {

constexpr Roundness kFine{0, 128, 128};

Vec3d front(const ShapeMesh& mesh, const ShapeMesh::Triangle& triangle) {
  const Vec3d& a = mesh.positions[triangle.position[0]];
  return vec::unit(vec::cross(vec::subtract(mesh.positions[triangle.position[1]], a),
                              vec::subtract(mesh.positions[triangle.position[2]], a)));
}

/// Sixth of the triple products: of a closed mesh its volume, below 0 where fronts look inwards.
double volume(const std::vector<ShapeMesh>& meshes) {
  double sum = 0;
  for (const ShapeMesh& mesh : meshes)
    for (const auto& t : mesh.triangles)
      sum += vec::dot(mesh.positions[t.position[0]],
                      vec::cross(mesh.positions[t.position[1]], mesh.positions[t.position[2]])) /
             6;
  return sum;
}

/// Every edge is met once in each direction, by positions that are equal to the last bit.
bool closed(const std::vector<ShapeMesh>& meshes) {
  std::map<std::pair<Vec3d, Vec3d>, int> edges;
  for (const ShapeMesh& mesh : meshes)
    for (const auto& t : mesh.triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        Vec3d a = mesh.positions[t.position[i]];
        Vec3d b = mesh.positions[t.position[(i + 1) % 3]];
        ++edges[{a, b}];
        --edges[{b, a}];
      }
  return std::ranges::all_of(edges, [](const auto& edge) { return edge.second == 0; });
}

void expect_normals_at_fronts(const ShapeMesh& mesh, double least) {
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t n : triangle.normal) {
      EXPECT_NEAR(vec::length(mesh.normals[n]), 1, 1e-9);
      EXPECT_GT(vec::dot(mesh.normals[n], front(mesh, triangle)), least);
    }
}

TEST(Shapes, SphereIsClosedAndRound) {
  const ShapeMesh sphere = tessellated(Sphere{{1, 2, 3}, 2}, kFine);
  EXPECT_TRUE(closed({sphere}));
  EXPECT_NEAR(sphere.area(), area(Sphere{{1, 2, 3}, 2}), 0.003 * area(Sphere{{1, 2, 3}, 2}));
  EXPECT_NEAR(volume({sphere}), 32 * std::numbers::pi / 3, 0.2);
  expect_normals_at_fronts(sphere, 0.999);
  for (const Vec3d& p : sphere.positions) EXPECT_NEAR(vec::length(vec::subtract(p, {1, 2, 3})), 2, 1e-12);
}

// No triangle of a sphere is thin: the worst has half the area of the best.
TEST(Shapes, TrianglesOfASphereAreAlike) {
  const ShapeMesh sphere = tessellated(Sphere{{0, 0, 0}, 1}, kFine);
  double least = 1;
  double most = 0;
  for (const auto& t : sphere.triangles) {
    const Vec3d& a = sphere.positions[t.position[0]];
    const double twice = vec::length(vec::cross(vec::subtract(sphere.positions[t.position[1]], a),
                                                vec::subtract(sphere.positions[t.position[2]], a)));
    least = std::min(least, twice);
    most = std::max(most, twice);
  }
  EXPECT_LT(most, 2.2 * least);
}

TEST(Shapes, NegativeRadiiLookInwards) {
  EXPECT_LT(volume({tessellated(Sphere{{0, 0, 0}, -1}, kFine)}), -4);
  expect_normals_at_fronts(tessellated(Sphere{{0, 0, 0}, -1}, kFine), 0.999);
  const RingTorus torus{{0, 0, 0}, {0, 1, 0}, -1, -2};
  EXPECT_LT(volume({tessellated(torus, kFine)}), -1);
  expect_normals_at_fronts(tessellated(torus, kFine), 0.99);
}

TEST(Shapes, Torus) {
  const RingTorus torus{{0, 5, 0}, {0, 3, 0}, 1, 2};
  const ShapeMesh mesh = tessellated(torus, kFine);
  EXPECT_TRUE(closed({mesh}));
  expect_normals_at_fronts(mesh, 0.99);
  EXPECT_NEAR(mesh.area(), area(torus), 0.002 * area(torus));
  // 2 pi^2 R r^2
  EXPECT_NEAR(volume({mesh}), 2 * std::numbers::pi * std::numbers::pi * 1.5 * 0.25, 0.02);
}

// A cone with discs on its ends closes to the last bit although their axes come from different numbers.
TEST(Shapes, ConeAndDiscsClose) {
  const Vec3d a{0.1, 0.2, 0.3};
  const Vec3d b{1.7, -0.4, 2.2};
  const Vec3d normal = vec::scale(vec::subtract(b, a), 0.377);
  const ShapeMesh side = tessellated(Cone{a, 0.5, b, 0.5}, kFine);
  const ShapeMesh top = tessellated(Ring{b, normal, 0, 0.5}, kFine);
  const ShapeMesh bottom = tessellated(Ring{a, vec::scale(normal, -2), 0, 0.5}, kFine);
  EXPECT_TRUE(closed({side, top, bottom}));
  EXPECT_NEAR(volume({side, top, bottom}), std::numbers::pi * 0.25 * vec::length(vec::subtract(b, a)), 0.01);
  expect_normals_at_fronts(side, 0.999);
  EXPECT_NEAR(side.area() + top.area(), area(Cone{a, 0.5, b, 0.5}) + area(Ring{b, normal, 0, 0.5}), 0.01);
}

TEST(Shapes, ConesWithATip) {
  for (const Cone& cone :
       {Cone{{0, 0, 0}, 0, {0, 0, 2}, 1}, {{0, 0, 0}, 1, {0, 0, 2}, 0}, {{0, 0, 0}, -1, {0, 0, 2}, 0}}) {
    const ShapeMesh mesh = tessellated(cone, kFine);
    EXPECT_EQ(mesh.triangles.size(), triangles_of(cone, kFine));
    EXPECT_NEAR(mesh.area(), area(cone), 0.002 * area(cone));
    expect_normals_at_fronts(mesh, 0.999);
  }
}

TEST(Shapes, RingWithAHoleLooksAlongItsNormal) {
  const Ring ring{{0, 0, 1}, {0, 0, -2}, 1, 2};
  const ShapeMesh mesh = tessellated(ring, kFine);
  EXPECT_EQ(mesh.triangles.size(), triangles_of(ring, kFine));
  EXPECT_NEAR(mesh.area(), 3 * std::numbers::pi, 0.01);
  for (const auto& t : mesh.triangles) EXPECT_NEAR(front(mesh, t)[2], -1, 1e-12);
}

TEST(Shapes, BoundsHoldWhatIsMade) {
  const Vec3d axis{1, 2, 3};
  for (const Shape& shape : {Shape(Sphere{{1, 0, 0}, -2}), Shape(Cone{{0, 0, 0}, 1, axis, 2}),
                             Shape(Ring{{1, 1, 1}, axis, 0, 3}), Shape(RingTorus{{0, 1, 0}, axis, 1, 2})}) {
    const vec::Box box = bounds(shape);
    vec::Box made;
    for (const Vec3d& p : tessellated(shape, kFine).positions) made.include(p);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LE(box.low[i], made.low[i] + 1e-8);
      EXPECT_GE(box.high[i], made.high[i] - 1e-8);
      EXPECT_NEAR(box.low[i], made.low[i], 0.05);
      EXPECT_NEAR(box.high[i], made.high[i], 0.05);
    }
  }
}

// The distance between circle and edge is at most the tolerance, and larger circles never get fewer edges.
TEST(Shapes, EdgesFollowTheTolerance) {
  const Roundness roundness{0.01, 12, 128};
  EXPECT_EQ(roundness.edges(1e-9), 12U);
  EXPECT_EQ(roundness.edges(1e9), 128U);
  std::uint32_t before = 0;
  for (double radius = 0.1; radius < 30; radius *= 1.1) {
    const std::uint32_t edges = roundness.edges(radius);
    EXPECT_EQ(edges % 4, 0U);
    EXPECT_GE(edges, before);
    if (edges < 128) {
      EXPECT_LE(radius * (1 - std::cos(std::numbers::pi / edges)), 0.01);
    }
    before = edges;
  }
}

}  // namespace
}  // namespace torolux
