// SPDX-License-Identifier: MIT
// What shadow rays aim at: all emitters, chosen by the light that they emit, in every PE's image or in none; and that
// vertex irradiance then lacks exactly the light straight from emitters.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "host_tools/layout/light_units.hpp"
#include "host_tools/layout/stage_image.hpp"
#include "host_tools/layout/stage_layout.hpp"
#include "host_tools/solution/solution.hpp"
#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux::test {
namespace {

using protocol::Emitter;

/// Three lamps of very different power above a floor.
Scene lamps(double weakest) {
  SceneBuilder builder;
  builder.quad(builder.material({0.5, 0.5, 0.5}), {0, 0, 0}, {4, 0, 0}, {4, 0, 4}, {0, 0, 4});
  builder.quad(builder.material({0, 0, 0}, {4, 2, 0}), {0, 3, 0}, {0, 3, 1}, {1, 3, 1}, {1, 3, 0});
  builder.triangle(builder.material({0, 0, 0}, {weakest, 0, 0}), {2, 3, 0}, {2, 3, 1}, {3, 3, 0});
  builder.triangle(builder.material({0, 0, 0}, {1, 1, 2}), {2, 3, 2}, {2, 3, 4}, {4, 3, 2});
  return builder.scene;
}

struct Chosen {
  Scene scene;
  Mesh mesh;
  LightUnits units;
  std::vector<Emitter> list;
};

Chosen chosen(double weakest, bool two_sided) {
  Chosen result{lamps(weakest), {}, {}, {}};
  result.mesh = make_mesh(result.scene, {2.0, 1.0, two_sided});
  result.units = light_units(result.scene, result.mesh, two_sided);
  result.list = emitters(result.scene, result.mesh, result.units);
  return result;
}

/// As the PEs see it: of 2^32 numbers, how many choose this one.
double chance(const std::vector<Emitter>& list, std::size_t i) {
  const double before = i == 0 ? -1.0 : list[i - 1].chosen_to;
  return std::ldexp(static_cast<double>(list[i].chosen_to) - before, -32);
}

// A lamp that is no small part of all surfaces; one of 2^-24 of them; one so small that more quanta might not fit.
TEST(PixelScale, IsFinerWhereEmittersAreSmall) {
  const auto of = [](double edge) {
    SceneBuilder builder;
    builder.quad(builder.material({0.5, 0.5, 0.5}), {0, 0, 0}, {4, 0, 0}, {4, 0, 4}, {0, 0, 4});
    builder.quad(builder.material({0, 0, 0}, {1, 2, 1}), {2, 3, 2}, {2, 3, 2 + edge}, {2 + edge, 3, 2 + edge},
                 {2 + edge, 3, 2});
    const Mesh mesh = make_mesh(builder.scene, {4.0, 4.0, false});
    return pixel_scale(mesh, light_units(builder.scene, mesh, false));
  };
  EXPECT_EQ(of(1), 0x1p40F);
  EXPECT_EQ(of(4 * 0x1.1p-12), 0x1p44F);
  EXPECT_EQ(of(1e-6), 0x1p52F);
}

TEST(Emitters, AreChosenByWhatTheyEmit) {
  const Chosen of = chosen(2, false);
  ASSERT_EQ(of.list.size(), 4U);
  EXPECT_EQ(of.list.back().chosen_to, 0xFFFF'FFFFU);
  // Flux, R + G + B, is proportional to area times radiance: 3, 3 (the square's halves), 1, 8.
  const std::array<double, 4> part{3.0 / 15, 3.0 / 15, 1.0 / 15, 8.0 / 15};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(chance(of.list, i), part[i], 1e-6) << i;  // areas in the mesh are of corners in float
    const MeshTriangle& triangle = of.mesh.triangles[of.list[i].polygon];
    EXPECT_EQ(of.list[i].corner, triangle.corner);
    EXPECT_EQ(of.list[i].both_sides, 0U);
    const double area = triangle.area * of.mesh.space.scale * of.mesh.space.scale;
    EXPECT_NEAR(static_cast<double>(of.list[i].area_over_chance) * chance(of.list, i) * std::numbers::pi, area,
                1e-6 * area);
  }
  EXPECT_EQ(of.list[0].emission, (protocol::Vec3f{1, 0.5F, 0})) << "in units of the greatest radiance";
}

TEST(Emitters, WhatEmitsNextToNothingIsLeftOut) {
  const Chosen of = chosen(1e-12, false);
  ASSERT_EQ(of.list.size(), 3U);
  for (const Emitter& emitter : of.list) EXPECT_GT(emitter.emission[1], 0.0F);
  EXPECT_EQ(of.list.back().chosen_to, 0xFFFF'FFFFU);
}

TEST(Emitters, EmitFromBothSidesWhereAsked) {
  for (const Emitter& emitter : chosen(2, true).list) EXPECT_EQ(emitter.both_sides, 1U);
}

TEST(Emitters, StandInEveryImageOrInNone) {
  const Chosen of = chosen(2, false);
  const Placement placement = make_placement(of.mesh, {{2, 2}, std::array<std::uint32_t, 3>{4, 4, 4}, "skewed"});
  const VertexIrradiance irradiance =
      make_vertex_irradiance(of.mesh, std::vector<protocol::Flux>(of.mesh.elements), 1, 1);
  StageParameters parameters = stage_parameters();
  const MemoryMap map{protocol::kLocalMemoryBase + 100'000, 64};
  for (const std::uint32_t count : {0U, 4U}) {
    parameters.emitters = count;
    for (protocol::PeNumber pe = 0; pe < 4; ++pe) {
      const auto layout = [&](protocol::Stage stage) {
        return lay_out(of.mesh, placement, pe, stage, parameters, map);
      };
      EXPECT_EQ(layout(protocol::Stage::radiosity).layout.emitters.count, 0U);
      const PeLayout rays = layout(protocol::Stage::ray_tracing);
      ASSERT_EQ(rays.layout.emitters.count, count);
      const auto image = ray_tracing_image(of.scene, of.mesh, placement, pe, of.units, irradiance, rays);
      const std::size_t at = rays.layout.emitters.address - rays.layout.cell_words.address;
      ASSERT_LE(at + count * sizeof(Emitter), image.size());
      EXPECT_EQ(std::memcmp(image.data() + at, of.list.data(), count * sizeof(Emitter)), 0);
    }
  }
}

TEST(IncidentFlux, LacksTheDirectPartOnRequest) {
  Solution solution;
  solution.elements = {{{10, 20, 30}, {1, 2, 3}}, {{5, 6, 7}, {5, 0, 7}}};
  EXPECT_EQ(incident_flux(solution, false), (std::vector<protocol::Flux>{{10, 20, 30}, {5, 6, 7}}));
  EXPECT_EQ(incident_flux(solution, true), (std::vector<protocol::Flux>{{9, 18, 27}, {0, 6, 0}}));
}

}  // namespace
}  // namespace torolux::test
