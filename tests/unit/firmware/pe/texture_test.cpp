// SPDX-License-Identifier: MIT
// Proves: textures are looked up where they should be, wrapped and bilinear; a ray shows them, with one texel for a
// corner as for all; and what they emit is not multiplied.
#include <gtest/gtest.h>

#include "firmware/protocol/texture.hpp"
#include "tests/unit/firmware/pe/fake_machine.hpp"

namespace torolux::test {
namespace {

using protocol::Texel;
using protocol::texture_colour;
using protocol::Vec3f;

/// Roots of the shares, of 1023.
constexpr Texel texel(std::uint32_t r, std::uint32_t g, std::uint32_t b) {
  return r | (g << 10U) | (b << 20U);
}

TEST(Texture, TexelsAreSquaresOfTheirRoots) {
  const Vec3f colour = protocol::texel_colour(texel(0, 1023, 512));
  EXPECT_EQ(colour[0], 0);
  EXPECT_NEAR(colour[1], 1, 1e-6);
  EXPECT_NEAR(colour[2], 512.0 * 512 / (1023 * 1023), 1e-6);
}

/// 3 wide, 2 high: red is 0, 1, 0 from left to right, green 0 below and 1 above.
constexpr std::array<Texel, 6> kTexels{texel(0, 0, 0),    texel(1023, 0, 0),    texel(0, 0, 0),
                                       texel(0, 1023, 0), texel(1023, 1023, 0), texel(0, 1023, 0)};

Vec3f at(float u, float v) {
  return texture_colour(kTexels.data(), 3, 2, {u, v});
}

TEST(Texture, IsBilinearBetweenMiddlesOfTexels) {
  EXPECT_NEAR(at(0.5F, 0.25F)[0], 1, 1e-6);
  EXPECT_NEAR(at(1 / 6.0F, 0.25F)[0], 0, 1e-6);
  EXPECT_NEAR(at(1 / 3.0F, 0.25F)[0], 0.5, 1e-6);
  EXPECT_NEAR(at(0.5F, 0.25F)[1], 0, 1e-6);
  EXPECT_NEAR(at(0.5F, 0.75F)[1], 1, 1e-6);
  EXPECT_NEAR(at(0.1F, 0.375F)[1], 0.25, 1e-6);
}

TEST(Texture, RepeatsInAllDirections) {
  EXPECT_NEAR(at(0.3F, 0.0F)[1], 0.5, 1e-6) << "between the highest row and the lowest of the next";
  EXPECT_NEAR(at(0.3F, 0.875F)[1], 0.75, 1e-6);
  for (const float periods : {-3.0F, -1.0F, 1.0F, 100.0F}) {
    for (std::uint32_t i = 0; i < 64; ++i) {
      const float u = static_cast<float>(i) / 64.0F;
      const Vec3f here = at(u, 1 - u);
      const Vec3f there = at(u + periods, 1 - u - periods);
      for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(here[c], there[c], 1e-4) << u << ' ' << periods;
    }
  }
  EXPECT_NEAR(at(-1e-9F, 0.25F)[0], 0, 1e-6) << "rounds to a whole period";
}

/// A room of reflectance 0.8 times a texture on the wall z low, in uniform light of irradiance pi.
protocol::RayRecord ray_to(const TestScene& scene, const glm::vec3& target, std::uint32_t pixel) {
  protocol::RayRecord r{};
  const glm::vec3 origin{0.5F, 0.5F, 0.9F};
  r.origin = pe::to_array(origin);
  r.direction = pe::to_array(glm::normalize(target - origin));
  r.weight = {1, 1, 1};
  r.place = scene.place_of(origin);
  r.polygon = protocol::kNoPolygon;
  r.pixel = pixel;
  r.flags = protocol::kFirst;
  return r;
}

TEST(Texture, IsSeenOnItsPolygons) {
  for (const std::uint32_t pes : {1U, 3U}) {
    TestScene scene;
    scene.pes = pes;
    scene.cells = {2, 3, 2};
    scene.materials = {diffuse_material(0.5F), diffuse_material(0.8F, 0.125F)};
    add_room(scene, {0, 0, 0}, {1, 1, 1}, 1, 0);
    scene.polygons[0].material = scene.polygons[1].material =
        1;  // z low: (0, 0), (1, 0), (1, 1) and (0, 0), (1, 1), (0, 1)
    FakeMachine machine(pes);
    machine.load(scene, protocol::Stage::ray_tracing, 64, 1, [](PeStores& stores) {
      stores.textures = {{1, 1, 6}, {3, 2, 0}};
      stores.texels.assign(kTexels.begin(), kTexels.end());
      stores.texels.push_back(0);
      stores.materials[1].texture = 1;
      stores.texture_points = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
      stores.polygons[0].texture_points = 0;
      stores.polygons[1].texture_points = 3;
    });
    for (std::uint16_t p = 0; p < pes; ++p) machine.message(p, protocol::MessageKind::begin);
    machine.run();
    const std::array<glm::vec3, 4> targets{
        glm::vec3{0.5F, 0.25F, 0}, {0.2F, 0.875F, 0}, {1 / 3.0F, 0.75F, 0}, {0, 0.5F, 0.5F}};
    for (std::uint32_t i = 0; i < targets.size(); ++i) {
      const protocol::RayRecord ray = ray_to(scene, targets[i], i);
      const auto* bytes = reinterpret_cast<const std::byte*>(&ray);
      const auto cell = scene.cell_of({0.5, 0.5, 0.9});
      machine.send({protocol::kHost, scene.pe_of(cell[0], cell[1], cell[2]), {{bytes, bytes + sizeof ray}}});
      machine.run();
    }
    const auto seen = [&](std::uint32_t pixel, std::size_t c) {
      return static_cast<double>(machine.pixels.at(pixel)[c]) * 0x1p-20;
    };
    EXPECT_NEAR(seen(0, 0), 0.125 + 0.8, 1e-4);
    EXPECT_NEAR(seen(0, 1), 0.125, 1e-4);
    EXPECT_NEAR(seen(1, 1), 0.125 + 0.8 * 0.75, 1e-4);
    EXPECT_NEAR(seen(2, 0), 0.125 + 0.8 * 0.5, 1e-4);
    EXPECT_NEAR(seen(2, 1), 0.125 + 0.8, 1e-4);
    EXPECT_NEAR(seen(3, 2), 0.5, 1e-4);
  }
}

}  // namespace
}  // namespace torolux::test
