// SPDX-License-Identifier: MIT
// The lattice: averages around vertices, continuity over smooth edges, and nothing across sharp ones.
#include "host_tools/mesh/lattice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "firmware/protocol/triangle_grid.hpp"
#include "tests/unit/host/test_scenes.hpp"

namespace torolux {
namespace {

/// Value of a triangle's front lattice at a point of its edge, by linear interpolation between lattice vertices.
/// along: 0..1 from corner `edge` to corner edge + 1.
double on_edge(const Mesh& mesh, const Lattice& lattice, std::uint32_t t, std::uint32_t edge, double along) {
  const std::uint32_t level = mesh.triangles[t].element_level;
  const std::uint32_t n = 1U << level;
  const auto vertex = [&](std::uint32_t k) {
    const std::uint32_t i = edge == 0 ? k : edge == 1 ? n - k : 0;
    const std::uint32_t j = edge == 0 ? 0 : edge == 1 ? k : n - k;
    return static_cast<double>(
        lattice.values[lattice.first[t][0] + protocol::lattice_index(i, j, level)].irradiance_over_pi[0]);
  };
  const double at = along * n;
  const auto k = std::min(static_cast<std::uint32_t>(at), n - 1);
  return vertex(k) + (vertex(k + 1) - vertex(k)) * (at - k);
}

/// Flux that rises over the scene: a hash would do as well, but this shows in failures where it comes from.
std::vector<protocol::Flux> uneven_flux(const Mesh& mesh) {
  std::vector<protocol::Flux> flux(mesh.elements);
  for (std::uint32_t e = 0; e < mesh.elements; ++e) flux[e] = {1000 + (e * 7919) % 10007, 5, 0};
  return flux;
}

Scene strip() {
  // Three quads side by side, of which the middle one is larger: its triangles are cut more finely.
  test::SceneBuilder builder;
  const std::uint32_t white = builder.material({0.5, 0.5, 0.5});
  builder.quad(white, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  builder.triangle(white, {1, 0, 0}, {7, 0, 0}, {1, 1, 0});
  builder.quad(builder.material({0, 0, 0}, {1, 1, 1}), {0, 0, 2}, {0, 1, 2}, {1, 1, 2}, {1, 0, 2});
  return builder.scene;
}

TEST(Lattice, EqualIrradianceStaysEqual) {
  const Mesh mesh = make_mesh(test::room_with_box(), {.patch_length = 0.6, .element_length = 0.2});
  std::vector<protocol::Flux> flux(mesh.elements);
  for (const MeshTriangle& triangle : mesh.triangles) {
    const std::uint32_t count = protocol::triangles_of_level(triangle.element_level);
    for (const std::uint32_t first : triangle.first_element) {
      if (first == protocol::kNoSide) continue;
      for (std::uint32_t e = 0; e < count; ++e) {
        flux[first + e] = {std::llround(triangle.area / count * 3e12), 0, 0};
      }
    }
  }
  const Lattice lattice = make_lattice(mesh, flux, 1e-12, 2.0);
  // 3 W/m^2 over pi, in units of 2; the flux is rounded to 1e-12 of it, floats to 6e-8.
  const double expected = 3 / std::numbers::pi / 2;
  for (const auto& value : lattice.values) {
    EXPECT_NEAR(static_cast<double>(value.irradiance_over_pi[0]), expected, 1e-6 * expected);
    EXPECT_EQ(value.irradiance_over_pi[1], 0.0F);
  }
}

TEST(Lattice, ContinuousOverSharedEdgesWithHangingVertices) {
  const Mesh mesh = make_mesh(strip(), {.patch_length = 10, .element_length = 0.8});
  ASSERT_NE(mesh.triangles[0].element_level, mesh.triangles[2].element_level) << "no hanging vertices to test";
  const Lattice lattice = make_lattice(mesh, uneven_flux(mesh), 1.0, 1.0);
  int edges = 0;
  for (std::uint32_t a = 0; a < 3; ++a) {
    for (std::uint32_t b = a + 1; b < 3; ++b) {
      for (std::uint32_t e = 0; e < 3; ++e) {
        for (std::uint32_t f = 0; f < 3; ++f) {
          const auto& pa = mesh.triangles[a].position;
          const auto& pb = mesh.triangles[b].position;
          if (pa[e] != pb[(f + 1) % 3] || pa[(e + 1) % 3] != pb[f]) continue;
          ++edges;
          for (int k = 0; k <= 64; ++k) {
            const double along = k / 64.0;
            const double value = on_edge(mesh, lattice, a, e, along);
            EXPECT_NEAR(value, on_edge(mesh, lattice, b, f, 1 - along), 1e-5 * value) << "edge of " << a << ", " << b;
          }
        }
      }
    }
  }
  EXPECT_EQ(edges, 2);
}

TEST(Lattice, SharpEdgesKeepTheirOwnValues) {
  test::SceneBuilder builder;
  const std::uint32_t white = builder.material({0.5, 0.5, 0.5});
  builder.triangle(white, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  builder.triangle(white, {1, 0, 0}, {0, 0, 0}, {0, 0, 1});  // at a right angle
  builder.triangle(builder.material({0, 0, 0}, {1, 1, 1}), {0, 0, 2}, {0, 1, 2}, {1, 1, 2});
  const Mesh mesh = make_mesh(builder.scene, {.patch_length = 10, .element_length = 10});
  std::vector<protocol::Flux> flux(mesh.elements);
  flux[mesh.triangles[0].first_element[0]] = {100, 0, 0};
  const Lattice lattice = make_lattice(mesh, flux, std::numbers::pi, 1.0);
  EXPECT_FLOAT_EQ(lattice.values[lattice.first[0][0]].irradiance_over_pi[0], 200.0F);
  EXPECT_EQ(lattice.values[lattice.first[1][0]].irradiance_over_pi[0], 0.0F);
  EXPECT_EQ(lattice.values[lattice.first[0][1]].irradiance_over_pi[0], 0.0F) << "the back has sums of its own";
}

TEST(Lattice, VertexTakesAllElementsAroundIt) {
  test::SceneBuilder builder;
  const std::uint32_t white = builder.material({0.5, 0.5, 0.5});
  builder.quad(white, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});  // triangles 0-1-2 and 0-2-3, area 0.5 each
  builder.triangle(builder.material({0, 0, 0}, {1, 1, 1}), {0, 0, 2}, {0, 1, 2}, {1, 1, 2});
  const Mesh mesh = make_mesh(builder.scene, {.patch_length = 10, .element_length = 10});
  std::vector<protocol::Flux> flux(mesh.elements);
  flux[mesh.triangles[0].first_element[0]] = {100, 0, 0};
  flux[mesh.triangles[1].first_element[0]] = {300, 0, 0};
  const Lattice lattice = make_lattice(mesh, flux, std::numbers::pi, 1.0);
  const auto value = [&](std::uint32_t t, std::uint32_t vertex) {
    return lattice.values[lattice.first[t][0] + vertex].irradiance_over_pi[0];
  };
  EXPECT_FLOAT_EQ(value(0, 0), 400.0F);  // both, over an area of 1
  EXPECT_FLOAT_EQ(value(0, 1), 200.0F);  // only the first
  EXPECT_FLOAT_EQ(value(0, 2), 400.0F);
  EXPECT_FLOAT_EQ(value(1, 2), 600.0F);  // only the second
}

}  // namespace
}  // namespace torolux
