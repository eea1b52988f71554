// SPDX-License-Identifier: MIT
// Vertex irradiance: averages around vertices, continuity over smooth edges, and nothing across sharp ones.
#include "host_tools/irradiance/vertex_irradiance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "firmware/protocol/element_light.hpp"
#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/scene/vec.hpp"
#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux {
namespace {

/// Value at a point of a triangle, as light over the facet that holds it shows it.
double value_at(const Mesh& mesh, const VertexIrradiance& irradiance, std::uint32_t t, float b1, float b2,
                std::uint32_t side = 0) {
  const std::uint32_t f = mesh.facet_at(t, b1, b2);
  protocol::Weights at{(1.0F - b1) - b2, b1, b2};
  protocol::enter_level(at, protocol::level_of_code(mesh.facets[f].code));
  const protocol::CornerIrradiance& light = irradiance.triangles[irradiance.first[f] + side];
  const protocol::Weights by = protocol::light_weights(protocol::concave_corners(light), at);
  const auto red = [&light](std::size_t c) { return protocol::irradiance_at(light, c)[0]; };
  return static_cast<double>(by.b0 * red(0) + by.b1 * red(1) + by.b2 * red(2));
}

/// along: 0..1 from corner `edge` to corner edge + 1.
double on_edge(const Mesh& mesh, const VertexIrradiance& irradiance, std::uint32_t t, std::uint32_t edge,
               double along) {
  std::array<float, 3> weight{};
  weight[edge] = static_cast<float>(1 - along);
  weight[(edge + 1) % 3] = static_cast<float>(along);
  return value_at(mesh, irradiance, t, weight[1], weight[2]);
}

/// Flux that rises over the scene: a hash would do as well, but this shows in failures where it comes from.
std::vector<protocol::Flux> uneven_flux(const Mesh& mesh) {
  std::vector<protocol::Flux> flux(mesh.elements);
  for (std::uint32_t e = 0; e < mesh.elements; ++e) flux[e] = {1000 + (e * 7919) % 10007, 5, 0};
  return flux;
}

/// 3 W/m^2 of red everywhere, in quanta of 1e-12 W.
std::vector<protocol::Flux> equal_irradiance(const Mesh& mesh) {
  std::vector<protocol::Flux> flux(mesh.elements);
  for (const MeshPatch& patch : mesh.patches) {
    for (const std::uint32_t first : patch.first_element) {
      if (first == protocol::kNoSide) continue;
      for (std::uint32_t e = 0; e < patch.elements; ++e) {
        flux[first + e] = {std::llround(mesh.element_area(patch, e) * 3e12), 0, 0};
      }
    }
  }
  return flux;
}

Scene strip() {
  // A square and a larger triangle beside it, which is cut more finely.
  test::SceneBuilder builder;
  const std::uint32_t white = builder.material({0.5, 0.5, 0.5});
  builder.quad(white, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  builder.triangle(white, {1, 0, 0}, {3, 0.5, 0.2}, {1, 1, 0});  // bent, so that they are no region
  builder.quad(builder.material({0, 0, 0}, {1, 1, 1}), {0, 0, 2}, {0, 1, 2}, {1, 1, 2}, {1, 0, 2});
  return builder.scene;
}

TEST(VertexIrradiance, EqualIrradianceStaysEqual) {
  const Mesh mesh = make_mesh(test::room_with_box(), {.patch_length = 0.6, .element_length = 0.2});
  const std::vector<protocol::Flux> flux = equal_irradiance(mesh);
  const VertexIrradiance irradiance = make_vertex_irradiance(mesh, flux, 1e-12, 2.0);
  // 3 W/m^2 over pi, in units of 2; the flux is rounded to 1e-12 of it, floats to 6e-8.
  const double expected = 3 / std::numbers::pi / 2;
  for (const auto& triangle : irradiance.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const protocol::Vec3f value = protocol::irradiance_at(triangle, c);
      EXPECT_NEAR(static_cast<double>(value[0]), expected, 1e-6 * expected);
      EXPECT_EQ(value[1], 0.0F);
    }
  }
}

TEST(VertexIrradiance, ContinuousOverSharedEdgesWithHangingVertices) {
  const Mesh mesh = make_mesh(strip(), {.patch_length = 10, .element_length = 0.8});
  const auto level = [&](std::uint32_t t) {
    return protocol::level_of_code(mesh.facets[mesh.parts[mesh.triangles[t].first_part].facet].code);
  };
  ASSERT_NE(level(0), level(2)) << "no hanging vertices to test";
  const VertexIrradiance irradiance = make_vertex_irradiance(mesh, uneven_flux(mesh), 1.0, 1.0);
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
            const double value = on_edge(mesh, irradiance, a, e, along);
            EXPECT_NEAR(value, on_edge(mesh, irradiance, b, f, 1 - along), 1e-5 * value)
                << "edge of " << a << ", " << b;
          }
        }
      }
    }
  }
  EXPECT_EQ(edges, 2);
}

TEST(VertexIrradiance, SharpEdgesKeepTheirOwnValues) {
  test::SceneBuilder builder;
  const std::uint32_t white = builder.material({0.5, 0.5, 0.5});
  builder.triangle(white, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  builder.triangle(white, {1, 0, 0}, {0, 0, 0}, {0, 0, 1});  // at a right angle
  builder.triangle(builder.material({0, 0, 0}, {1, 1, 1}), {0, 0, 2}, {0, 1, 2}, {1, 1, 2});
  const Mesh mesh = make_mesh(builder.scene, {.patch_length = 10, .element_length = 10});
  std::vector<protocol::Flux> flux(mesh.elements);
  flux[mesh.patches[0].first_element[0]] = {100, 0, 0};
  const VertexIrradiance irradiance = make_vertex_irradiance(mesh, flux, std::numbers::pi, 1.0);
  EXPECT_FLOAT_EQ(protocol::irradiance_at(irradiance.triangles[irradiance.first[0]], 0)[0], 200.0F);
  EXPECT_EQ(irradiance.triangles[irradiance.first[1]].irradiance_over_pi[0][0], 0.0F);
  EXPECT_EQ(irradiance.triangles[irradiance.first[0] + 1].irradiance_over_pi[0][0], 0.0F)
      << "the back has sums of its own";
}

/// A square floor of edge 2, cut in eight right triangles around its middle: (0, 0) .. (2, 2), y up.
test::SceneBuilder floor_around_a_vertex(std::uint32_t& white) {
  test::SceneBuilder builder;
  white = builder.material({0.5, 0.5, 0.5});
  constexpr double h = 1e-4;  // bent a little, so that they are no flat region
  const std::array<Vec3d, 9> rim{
      {{1, 0, 0}, {2, 0, h}, {2, 1, 0}, {2, 2, h}, {1, 2, 0}, {0, 2, h}, {0, 1, 0}, {0, 0, h}, {1, 0, 0}}};
  for (std::size_t i = 0; i < 8; ++i) builder.triangle(white, {1, 1, 0}, rim[i], rim[i + 1]);
  builder.triangle(builder.material({0, 0, 0}, {1, 1, 1}), {0, 0, 4}, {0, 1, 4}, {1, 1, 4});
  return builder;
}

TEST(VertexIrradiance, VertexTakesAllElementsAroundIt) {
  std::uint32_t white = 0;
  const Mesh mesh = make_mesh(floor_around_a_vertex(white).scene, {.patch_length = 10, .element_length = 1.5});
  std::vector<protocol::Flux> flux(mesh.elements);
  for (std::size_t p = 0; p < 8; ++p) flux[mesh.patches[p].first_element[0]] = {100 * static_cast<int>(p + 1), 0, 0};
  const VertexIrradiance irradiance = make_vertex_irradiance(mesh, flux, std::numbers::pi, 1.0);
  for (std::uint32_t f = 0; f < 8; ++f) {
    EXPECT_FLOAT_EQ(irradiance.triangles[irradiance.first[f]].irradiance_over_pi[0][0], 900.0F)
        << "3600 over an area of 4";
  }
}

// What interpolation gives each element on the average is the light that came to it: also at borders, where the mean
// of the elements around a vertex lies inside.
TEST(VertexIrradiance, FollowsAGradientToTheBorder) {
  test::SceneBuilder builder;
  const std::uint32_t white = builder.material({0.5, 0.5, 0.5});
  builder.quad(white, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  builder.triangle(builder.material({0, 0, 0}, {1, 1, 1}), {0, 0, 4}, {0, 1, 4}, {1, 1, 4});
  const Mesh mesh = make_mesh(builder.scene, {.patch_length = 10, .element_length = 0.2});
  std::vector<protocol::Flux> flux(mesh.elements);
  for (std::size_t p = 0; p < 2; ++p) {
    const MeshPatch& patch = mesh.patches[p];
    for (std::uint32_t e = 0; e < patch.elements; ++e) {
      const auto corner = grid_corners(mesh.triangles[p], mesh.facets[patch.first_facet + e].code);
      const double x = (corner[0][0] + corner[1][0] + corner[2][0]) / 3 / mesh.space.scale;  // from about 0 to 1
      flux[patch.first_element[0] + e] = {std::llround(mesh.element_area(patch, e) * (1 + x) * 1e9), 0, 0};
    }
  }
  const VertexIrradiance irradiance = make_vertex_irradiance(mesh, flux, 1e-9 * std::numbers::pi, 1.0);
  // One step of half an element, 0.06, would be missing without; after three steps an eighth of it is left.
  const double low = value_at(mesh, irradiance, 0, 0.0F, 0.0F);
  const double high = value_at(mesh, irradiance, 0, 1.0F, 0.0F);
  EXPECT_NEAR(high - low, 1.0, 0.05);
}

// A wall on the floor: light on one side of it must not show on the other, nor the dark of what it covers.
TEST(VertexIrradiance, NothingPassesUnderAWall) {
  for (const double height : {0.0, 0.0005}) {  // standing on it, or hanging close over it
    test::SceneBuilder builder;
    const std::uint32_t white = builder.material({0.5, 0.5, 0.5});
    builder.quad(white, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    // Off the lines between elements, at x = 0.3; through the floor's diagonal.
    builder.quad(white, {0.3, 0, height}, {0.3, 1, height}, {0.3, 1, 1}, {0.3, 0, 1});
    builder.triangle(builder.material({0, 0, 0}, {1, 1, 1}), {0, 0, 4}, {0, 1, 4}, {1, 1, 4});
    const Mesh mesh = make_mesh(builder.scene, {.patch_length = 0.5, .element_length = 0.25});
    std::vector<protocol::Flux> flux(mesh.elements);
    double widest = 0;
    for (const MeshPatch& patch : mesh.patches) {
      if (mesh.facets[patch.first_facet].triangle > 1) continue;
      for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
        const MeshFacet& facet = mesh.facets[f];
        const auto corner = grid_corners(mesh.triangles[facet.triangle], facet.code);
        const auto x = [&](std::size_t c) {
          return (corner[c][0] - mesh.triangles[0].corner[0][0]) / mesh.space.scale;
        };
        const auto [least, most] = std::minmax({x(0), x(1), x(2)});
        if (least < 0.299 && most > 0.301) widest = std::max(widest, most - least);
        const bool lit = (x(0) + x(1) + x(2)) / 3 > 0.3;
        const double area = mesh.facet_area(facet) / facet.of_element;
        flux[patch.first_element[0] + facet.element] = {lit ? std::llround(area * 1e12) : 0, 0, 0};
      }
    }
    EXPECT_LT(widest, 0.008) << "elements that a wall crosses are cut";
    const VertexIrradiance irradiance = make_vertex_irradiance(mesh, flux, 1e-12 * std::numbers::pi, 1.0);
    for (const float y : {0.2F, 0.5F, 0.9F}) {
      const auto at = [&](float x) {  // triangle 0: below the diagonal, corners (0,0) (1,0) (1,1)
        return x > y ? value_at(mesh, irradiance, 0, x - y, y) : value_at(mesh, irradiance, 1, x, y - x);
      };
      // Weights in float, doubled at each of 7 levels.
      EXPECT_NEAR(at(0.30F - 0.008F), 0.0, 1e-5) << "height " << height << " y " << y;
      EXPECT_NEAR(at(0.30F + 0.008F), 1.0, 1e-5) << "height " << height << " y " << y;
    }
  }
}

// Small triangles of a round surface receive together, and their light is smooth over all of them.
TEST(VertexIrradiance, ClustersAreSmooth) {
  const Mesh mesh = make_mesh(test::finely_tessellated_floor(), {.patch_length = 2, .element_length = 0.3});
  std::size_t clustered = 0;
  for (const MeshPatch& patch : mesh.patches) clustered += patch.is_clustered() ? 1 : 0;
  ASSERT_GT(clustered, 0U);
  EXPECT_LT(mesh.elements, mesh.facets.size() / 4);
  const VertexIrradiance even = make_vertex_irradiance(mesh, equal_irradiance(mesh), 1e-12, 1);
  for (const auto& triangle : even.triangles) {
    for (const protocol::Vec3f& value : triangle.irradiance_over_pi) {
      EXPECT_NEAR(static_cast<double>(value[0]), 3 / std::numbers::pi, 1e-5);
    }
  }
  // One vertex and normal, one value: continuous over all triangles of the same slope.
  const VertexIrradiance irradiance = make_vertex_irradiance(mesh, uneven_flux(mesh), 1.0, 1.0);
  std::map<std::array<long, 3>, float> value_of;
  for (std::uint32_t f = 0; f < mesh.facets.size(); ++f) {
    const MeshTriangle& triangle = mesh.triangles[mesh.facets[f].triangle];
    if (triangle.material != 0) continue;
    const Vec3d normal = mesh.facet_normal(mesh.facets[f]);
    for (std::size_t c = 0; c < 3; ++c) {
      const float value = irradiance.triangles[irradiance.first[f]].irradiance_over_pi[c][0];
      const auto [found, fresh] = value_of.emplace(
          std::array<long, 3>{triangle.position[c], std::lround(1e4 * normal[0]), std::lround(1e4 * normal[1])}, value);
      EXPECT_NEAR(found->second, value, 1e-4F * value) << (fresh ? "" : "a second value");
    }
  }
}

/// A ball of radius 0.5, about, whose vertices lie higher and lower by turns.
Scene ball_with_relief() {
  test::SceneBuilder builder;
  const std::uint32_t white = builder.material({0.5, 0.5, 0.5});
  constexpr int around = 96;
  constexpr int rings = 48;
  const auto at = [](int i, int j) {
    const double theta = std::numbers::pi * j / rings;
    const double phi = 2 * std::numbers::pi * (i % around) / around;
    const double radius = j == 0 || j == rings ? 0.5 : 0.5 + 0.002 * ((i % 2 + j / 2) % 2);
    return Vec3d{radius * std::sin(theta) * std::cos(phi), radius * std::sin(theta) * std::sin(phi),
                 radius * std::cos(theta)};
  };
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < around; ++i) {
      if (j > 0) builder.triangle(white, at(i, j), at(i + 1, j + 1), at(i + 1, j));
      if (j + 1 < rings) builder.triangle(white, at(i, j), at(i, j + 1), at(i + 1, j + 1));
    }
  }
  builder.triangle(builder.material({0, 0, 0}, {1, 1, 1}), {0, 0, 2}, {0, 1, 2}, {1, 1, 2});
  return builder.scene;
}

// Each triangle is shown as bright as it faces the light, though its cluster's flux is all that is known.
TEST(VertexIrradiance, TrianglesOfClustersShowTheirOwnNormals) {
  const Mesh mesh = make_mesh(ball_with_relief(), {.patch_length = 0.5, .element_length = 0.15});
  const Vec3d towards_light = vec::unit({1, 0.5, 1});
  const auto truth = [&](const MeshFacet& facet) { return 1 + vec::dot(mesh.facet_normal(facet), towards_light); };
  std::vector<double> exact(mesh.elements, 0);
  for (const MeshPatch& patch : mesh.patches) {
    if (patch.material != 0) continue;
    for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
      const MeshFacet& facet = mesh.facets[f];
      exact[patch.first_element[0] + facet.element] += 1e9 * truth(facet) * mesh.facet_area(facet);
    }
  }
  std::vector<protocol::Flux> flux(mesh.elements);
  for (std::uint32_t e = 0; e < mesh.elements; ++e) flux[e] = {std::llround(exact[e]), 0, 0};
  const VertexIrradiance irradiance = make_vertex_irradiance(mesh, flux, 1e-9 * std::numbers::pi, 1.0);
  double spread = 0;  // of the truth around its cluster's mean
  double error = 0;
  double sum_shown = 0;
  double sum = 0;
  for (const MeshPatch& patch : mesh.patches) {
    if (!patch.is_clustered()) continue;
    for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
      const MeshFacet& facet = mesh.facets[f];
      const double area = mesh.facet_area(facet);
      const double own = exact[patch.first_element[0] + facet.element] * 1e-9 / mesh.element_area(patch, facet.element);
      const auto& corner = irradiance.triangles[irradiance.first[f]].irradiance_over_pi;
      const double shown = static_cast<double>(corner[0][0] + corner[1][0] + corner[2][0]) / 3;
      sum_shown += area * shown;
      sum += area * truth(facet);
      spread += area * (truth(facet) - own) * (truth(facet) - own);
      error += area * (truth(facet) - shown) * (truth(facet) - shown);
    }
  }
  ASSERT_GT(spread, 0.0);
  EXPECT_LT(std::sqrt(error / spread), 0.5);
  EXPECT_NEAR(sum_shown, sum, 0.005 * sum) << "the mean stays what came";
}

// A dome of light over the floor: smoothing flattens it, but not by much.
TEST(VertexIrradiance, ClustersKeepTheirOwnLight) {
  const Mesh mesh = make_mesh(test::finely_tessellated_floor(), {.patch_length = 2, .element_length = 0.2});
  std::vector<double> exact(mesh.elements, 0);
  const auto for_each_floor_facet = [&](const auto& visit) {
    for (const MeshPatch& patch : mesh.patches) {
      if (!patch.is_clustered()) continue;
      for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
        visit(f, patch.first_element[0] + mesh.facets[f].element, mesh.facet_area(mesh.facets[f]));
      }
    }
  };
  for_each_floor_facet([&](std::uint32_t f, std::uint32_t element, double area) {
    const auto corner = grid_corners(mesh.triangles[mesh.facets[f].triangle], mesh.facets[f].code);
    const double x = (corner[0][0] + corner[1][0] + corner[2][0]) / 3 / mesh.space.scale + mesh.space.origin[0];
    exact[element] += 1e9 * area * x * (1 - x);
  });
  std::vector<protocol::Flux> flux(mesh.elements);
  for (std::uint32_t e = 0; e < mesh.elements; ++e) flux[e] = {std::llround(exact[e]), 0, 0};
  const VertexIrradiance irradiance = make_vertex_irradiance(mesh, flux, 1e-9 * std::numbers::pi, 1.0);
  std::vector<double> shown(mesh.elements, 0);
  for_each_floor_facet([&](std::uint32_t f, std::uint32_t element, double area) {
    const auto& corner = irradiance.triangles[irradiance.first[f]].irradiance_over_pi;
    shown[element] += 1e9 * area * static_cast<double>(corner[0][0] + corner[1][0] + corner[2][0]) / 3;
  });
  double missing = 0;
  double sum = 0;
  for (std::uint32_t e = 0; e < mesh.elements; ++e) {
    missing += std::abs(exact[e] - shown[e]);
    sum += exact[e];
  }
  ASSERT_GT(sum, 0.0);
  EXPECT_LT(missing / sum, 0.05) << "0.08 with nothing made up";
}

// Two finely tessellated floors, one close over the other: light on one must not show on the other.
TEST(VertexIrradiance, NothingPassesBetweenClustersThatDoNotTouch) {
  test::SceneBuilder builder;
  const std::uint32_t lit = builder.material({0.5, 0.5, 0.5});
  const std::uint32_t dark = builder.material({0.4, 0.4, 0.4});
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      const auto at = [&](int a, int b, double z) {  // nowhere flat
        return Vec3d{a / 20.0, b / 20.0, z + 1e-3 * std::sin(3.0 * a * a + 5.0 * b * b + a * b)};
      };
      builder.quad(lit, at(i, j, 0.02), at(i + 1, j, 0.02), at(i + 1, j + 1, 0.02), at(i, j + 1, 0.02));
      builder.quad(dark, at(i, j, 0), at(i + 1, j, 0), at(i + 1, j + 1, 0), at(i, j + 1, 0));
    }
  }
  builder.triangle(builder.material({0, 0, 0}, {1, 1, 1}), {0, 0, 2}, {0, 1, 2}, {1, 1, 2});
  const Mesh mesh = make_mesh(builder.scene, {.patch_length = 2, .element_length = 0.3});
  std::vector<protocol::Flux> flux(mesh.elements);
  for (const MeshPatch& patch : mesh.patches) {
    if (patch.material != lit) continue;
    ASSERT_TRUE(patch.is_clustered());
    for (std::uint32_t e = 0; e < patch.elements; ++e) flux[patch.first_element[0] + e] = {1'000'000, 0, 0};
  }
  const VertexIrradiance irradiance = make_vertex_irradiance(mesh, flux, 1, 1);
  for (const MeshPatch& patch : mesh.patches) {
    for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
      for (const auto& value : irradiance.triangles[irradiance.first[f]].irradiance_over_pi) {
        if (patch.material == lit) {
          EXPECT_GT(value[0], 0.0F);
        } else {
          EXPECT_EQ(value[0], 0.0F);
        }
      }
    }
  }
}

/// Flux over no area is no irradiance, and not the flux either.
TEST(VertexIrradiance, WhatIsNotSeenAtAllIsDark) {
  Mesh mesh = make_mesh(test::room_with_box(), {.patch_length = 0.6, .element_length = 0.2});
  for (MeshFacet& facet : mesh.facets) facet.seen = 0;
  for (const auto& triangle : make_vertex_irradiance(mesh, uneven_flux(mesh), 1, 1).triangles) {
    for (const protocol::Vec3f& value : triangle.irradiance_over_pi) EXPECT_EQ(value, (protocol::Vec3f{0, 0, 0}));
  }
}

}  // namespace
}  // namespace torolux
