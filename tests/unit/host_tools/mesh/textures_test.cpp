// SPDX-License-Identifier: MIT
// Proves: the machine's textures are area means of the images, and patches reflect the mean of what is seen on them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/layout/stage_image.hpp"
#include "host_tools/scene/textures.hpp"
#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux {
namespace {

SceneTexture image(std::uint32_t width, std::uint32_t height) {
  SceneTexture texture{"made up", width, height, {}};
  for (std::uint32_t i = 0; i < width * height; ++i) {
    texture.texels.push_back({static_cast<std::uint8_t>(i * 37), static_cast<std::uint8_t>(i * i), 128});
  }
  return texture;
}

/// Mean of one channel, linear.
double mean(const SceneTexture& texture, std::size_t channel) {
  double sum = 0;
  for (const auto& texel : texture.texels) sum += linear_of_srgb(texel[channel]);
  return sum / static_cast<double>(texture.texels.size());
}
double mean(const MachineTexture& texture, std::size_t channel) {
  double sum = 0;
  for (const protocol::Texel texel : texture.texels) sum += static_cast<double>(protocol::texel_colour(texel)[channel]);
  return sum / static_cast<double>(texture.texels.size());
}

TEST(MachineTexture, KeepsTexelsThatFit) {
  const SceneTexture from = image(13, 7);
  const MachineTexture texture = machine_texture(from, 91);
  ASSERT_EQ(texture.width, 13U);
  ASSERT_EQ(texture.height, 7U);
  for (std::size_t i = 0; i < 91; ++i) {
    const protocol::Vec3f colour = protocol::texel_colour(texture.texels[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      // Half a unit of the root, 1/2046, twice.
      ASSERT_NEAR(static_cast<double>(colour[c]), linear_of_srgb(from.texels[i][c]), 1.0 / 1023) << i;
    }
  }
}

TEST(MachineTexture, ShrinksToTheLimitInItsShapeAndKeepsTheMean) {
  const SceneTexture from = image(120, 50);
  for (const std::uint32_t most : {5999U, 1000U, 77U, 8U, 1U}) {
    const MachineTexture texture = machine_texture(from, most);
    EXPECT_LE(texture.width * texture.height, most);
    EXPECT_GE((texture.width + 1) * (texture.height + 1), most);
    EXPECT_EQ(texture.texels.size(), std::size_t{texture.width} * texture.height);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(mean(texture, c), mean(from, c), 0.001) << most;
  }
  const MachineTexture line = machine_texture(image(16384, 1), 100);
  EXPECT_EQ(line.width, 100U);
  EXPECT_EQ(line.height, 1U);
}

// Where it does not repeat, a look-up up to its edges finds the outermost texels alone, and in between the same.
TEST(MachineTexture, DoesNotShineThroughFromTheOppositeEdgeWhereItIsClamped) {
  SceneTexture from{"made up", 4, 2, {}};
  for (std::uint8_t i = 0; i < 8; ++i)
    from.texels.push_back({static_cast<std::uint8_t>(i % 4 * 80), static_cast<std::uint8_t>(i / 4 * 255), 128});
  const MachineTexture repeating = machine_texture(from, 8);
  from.clamped = true;
  const MachineTexture clamped = machine_texture(from, 8);
  const auto seen = [](const MachineTexture& texture, float u, float v) {
    return protocol::texture_colour(texture.texels.data(), texture.width, texture.height, texture.placed({u, v}));
  };
  for (const float v : {0.0F, 0.1F, 0.25F}) {
    for (const float u : {0.0F, 0.05F, 0.125F}) {
      EXPECT_NEAR(seen(clamped, u, v)[0], 0, 1e-4) << u << " " << v;
      EXPECT_NEAR(seen(clamped, 1 - u, v)[0], linear_of_srgb(240), 2e-3) << u << " " << v;
      EXPECT_NEAR(seen(clamped, u, v)[1], 0, 1e-4) << u << " " << v;
      EXPECT_NEAR(seen(clamped, u, 1 - v)[1], 1, 1e-4) << u << " " << v;
    }
  }
  for (const float v : {0.25F, 0.4F, 0.75F})
    for (const float u : {0.125F, 0.3F, 0.6F, 0.875F})
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(seen(clamped, u, v)[c], seen(repeating, u, v)[c], 1e-4) << u << " " << v << " " << c;
  // Nor beyond the machine's longest edge.
  SceneTexture line{"made up", protocol::kMostTextureEdge, 1, {}, true};
  line.texels.resize(protocol::kMostTextureEdge);
  EXPECT_EQ(machine_texture(line, 1U << 20U).width, protocol::kMostTextureEdge);
}

using Corners = std::array<protocol::TexturePoint, 3>;

/// Left half black, right half white.
MachineTexture halves() {
  MachineTexture texture{64, 64, {}};
  for (std::uint32_t i = 0; i < 64 * 64; ++i) texture.texels.push_back(i % 64 < 32 ? 0 : 0x3FFF'FFFF);
  return texture;
}

TEST(TextureMeans, AreThoseOfTheArea) {
  const TextureMeans means(halves());
  EXPECT_NEAR(means.over(Corners{{{0, 0}, {1, 0}, {0, 1}}})[0], 0.25, 0.01);
  EXPECT_NEAR(means.over(Corners{{{1, 1}, {0, 1}, {1, 0}}})[1], 0.75, 0.01);
  EXPECT_NEAR(means.over(Corners{{{0.05F, 0.1F}, {0.45F, 0.1F}, {0.3F, 0.9F}}})[2], 0, 1e-6);
  EXPECT_NEAR(means.over(Corners{{{0.6F, 0.1F}, {0.9F, 0.1F}, {0.7F, 0.9F}}})[2], 1, 1e-6);
  // A thin triangle across the edge, and one of no area at all on it.
  EXPECT_NEAR(means.over(Corners{{{0.4F, 0.5F}, {0.6F, 0.5F}, {0.5F, 0.501F}}})[0], 0.5, 0.01);
  EXPECT_NEAR(means.over(Corners{{{0.5F, 0.5F}, {0.5F, 0.5F}, {0.5F, 0.5F}}})[0], 0.5, 1e-6);
  // Thousands of periods: the mean of all, whatever the pattern.
  EXPECT_NEAR(means.over(Corners{{{0, 0}, {5000, 0}, {0, 5000}}})[0], 0.5, 1e-6);
  EXPECT_NEAR(means.over(Corners{{{0, 0}, {12, 0}, {0, 12}}})[0], 0.5, 0.03);
}

/// A room with a textured floor, which only some PEs hold.
Scene textured_scene() {
  Scene scene = test::room_with_box();
  scene.textures = {image(8, 8), image(120, 50)};
  SceneMaterial material;
  material.diffuse = {0.5, 0.25, 1};
  material.texture = 1;
  scene.materials.push_back(material);
  for (std::size_t t = 0; t < 2; ++t) {
    SceneTriangle& triangle = scene.triangles[4 + t];
    triangle.material = static_cast<std::uint32_t>(scene.materials.size() - 1);
    triangle.texture_points = static_cast<std::uint32_t>(scene.texture_points.size());
    scene.texture_points.insert(scene.texture_points.end(), {{0, 0}, {1, 0}, {t == 0 ? 1.0 : 0.0, 1}});
  }
  return scene;
}

TEST(Reflectance, OfAPatchIsTheTexturesMeanOverIt) {
  const Scene scene = textured_scene();
  const Mesh mesh = make_mesh(scene, {.patch_length = 0.2, .element_length = 0.1, .texels = 1000});
  for (const MeshTriangle& triangle : mesh.triangles) {
    if (triangle.sides == 0) continue;
    const SceneMaterial& material = scene.materials[triangle.material];
    const std::uint32_t patches = protocol::triangles_of_level(triangle.patch_level);
    Vec3d sum{0, 0, 0};
    for (std::uint32_t p = 0; p < patches; ++p) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double reflectance =
            std::ldexp(mesh.patches[mesh.parts[triangle.first_part + p].patch].reflectance[c], -32);
        sum[c] += reflectance / patches;
        if (triangle.texture == protocol::kNoTexture) {
          ASSERT_NEAR(reflectance, material.diffuse[c], 1e-9);
        }
      }
    }
    if (triangle.texture == protocol::kNoTexture) continue;
    EXPECT_GT(patches, 16U);
    const auto* corner = &mesh.texture_points[triangle.texture_points];
    const Vec3d whole = TextureMeans(mesh.textures[1]).over({corner[0], corner[1], corner[2]});
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], material.diffuse[c] * whole[c], 0.005);
  }
}

// Two tiles side by side that each show all of the image: neither goes on with the other's, as repeating ones may.
TEST(Mesh, TilesWithATextureThatDoesNotRepeatEachShowAllOfIt) {
  Scene scene = test::room_with_box();
  scene.textures = {{"made up", 2, 1, {{0, 0, 0}, {255, 255, 255}}, true}};
  SceneMaterial material;
  material.diffuse = {0.5, 0.5, 0.5};
  material.texture = 0;
  scene.materials.push_back(material);
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  for (const double x : {0.25, 0.5, 0.75})
    for (const double z : {0.25, 0.5}) scene.positions.push_back({x, 0.9, z});
  for (std::uint32_t tile = 0; tile < 2; ++tile) {
    for (const std::array<std::uint32_t, 3>& corners : {std::array{0U, 1U, 3U}, std::array{0U, 3U, 2U}}) {
      SceneTriangle triangle{
          {}, {kNoNormal, kNoNormal, kNoNormal}, static_cast<std::uint32_t>(scene.materials.size() - 1)};
      triangle.texture_points = static_cast<std::uint32_t>(scene.texture_points.size());
      for (std::size_t i = 0; i < 3; ++i) {
        triangle.position[i] = first + 2 * tile + corners[i];
        scene.texture_points.push_back({corners[i] / 2 == 1 ? 1.0 : 0.0, corners[i] % 2 == 1 ? 1.0 : 0.0});
      }
      scene.triangles.push_back(triangle);
    }
  }
  const Mesh mesh = make_mesh(scene, {.patch_length = 0.2, .element_length = 0.1, .texels = 1000});
  std::size_t any = 0;
  for (const MeshTriangle& triangle : mesh.triangles) {
    if (triangle.texture == protocol::kNoTexture) continue;
    ++any;
    double least = 1;
    double most = 0;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const auto u = static_cast<double>(mesh.texture_points[triangle.texture_points + i].u);
      least = std::min(least, u);
      most = std::max(most, u);
    }
    // A texel of border on each side of two.
    EXPECT_NEAR(least, 0.25, 1e-6);
    EXPECT_NEAR(most, 0.75, 1e-6);
  }
  EXPECT_EQ(any, 4U);
}

TEST(StageImage, APeHoldsTheTexturesOfItsPolygonsAlone) {
  const Scene scene = textured_scene();
  const Mesh mesh = make_mesh(scene, {.patch_length = 0.4, .element_length = 0.2, .texels = 1000});
  const LightUnits units = light_units(scene, mesh, false);
  const Placement placement = make_placement(mesh, {{8, 4}, std::array<std::uint32_t, 3>{8, 8, 8}, "skewed"});
  const VertexIrradiance irradiance = make_vertex_irradiance(mesh, std::vector<protocol::Flux>(mesh.elements), 1e-3, 1);
  std::uint32_t with = 0;
  for (unsigned number = 0; number < placement.torus.pes(); ++number) {
    const auto pe = static_cast<protocol::PeNumber>(number);
    const PeLayout radiosity =
        lay_out(mesh, placement, pe, protocol::Stage::radiosity, test::stage_parameters(), {0x8001'0000, 64});
    EXPECT_EQ(radiosity.layout.textures.count + radiosity.layout.texels.count + radiosity.layout.texture_points.count,
              0U);
    const PeLayout layout =
        lay_out(mesh, placement, pe, protocol::Stage::ray_tracing, test::stage_parameters(), {0x8001'0000, 64});
    const protocol::StageLayout& l = layout.layout;
    const std::vector<std::byte> bytes = ray_tracing_image(scene, mesh, placement, pe, units, irradiance, layout);
    const auto at = [&]<class T>(const protocol::Store& store, std::size_t index, T value) {
      std::memcpy(&value, bytes.data() + store.address - l.cell_words.address + index * sizeof(T), sizeof(T));
      return value;
    };
    std::uint32_t shown = 0;
    for (std::uint32_t p = 0; p < l.polygons.count; ++p) {
      const auto polygon = at(l.polygons, p, protocol::Polygon{});
      const auto material = at(l.materials, polygon.material, protocol::Material{});
      const MeshTriangle& triangle = mesh.triangles[polygon.number];
      ASSERT_EQ(material.texture, triangle.texture == protocol::kNoTexture ? protocol::kNoTexture : 0U);
      if (material.texture == protocol::kNoTexture) continue;
      ++shown;
      const auto texture = at(l.textures, 0, protocol::Texture{});
      EXPECT_EQ(texture.width, mesh.textures[1].width);
      EXPECT_EQ(at(l.texels, texture.first_texel + 5, protocol::Texel{}), mesh.textures[1].texels[5]);
      for (std::uint32_t i = 0; i < 3; ++i) {
        const auto point = at(l.texture_points, polygon.texture_points + i, protocol::TexturePoint{});
        EXPECT_EQ(point.v, mesh.texture_points[triangle.texture_points + i].v);
      }
    }
    EXPECT_EQ(l.textures.count, shown > 0 ? 1U : 0U) << "PE " << pe;
    EXPECT_EQ(l.texels.count, shown > 0 ? mesh.textures[1].texels.size() : 0U);
    EXPECT_EQ(l.texture_points.count, 3 * shown);
    with += shown > 0 ? 1U : 0U;
  }
  EXPECT_GT(with, 0U);
  EXPECT_LT(with, placement.torus.pes());
}

}  // namespace
}  // namespace torolux
