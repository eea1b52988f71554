// SPDX-License-Identifier: MIT
// Proves: materials, lights and cameras of glTF files become what docs/gltf.md says, in its numbers.
#include <numbers>

#include "host_tools/scene/rough_surface.hpp"
#include "host_tools/scene/vec.hpp"
#include "tests/support/gltf_writer.hpp"
#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using Json = nlohmann::json;

Scene load(GltfWriter& file, const SceneOptions& options = {}) {
  const std::string json = file.gltf();
  MemoryFiles files({{"a.gltf", json}, {"a.bin", file.bytes()}});
  return load_scene_from(files, "a.gltf", options);
}

SceneMaterial material(const Json& values, const Json& more = Json::object()) {
  GltfWriter file = gltf_square();
  file.json["materials"][0] = {{"name", "m"}, {"pbrMetallicRoughness", values}};
  file.json["materials"][0].update(more);
  return load(file).materials.at(0);
}

void expect_near(const Vec3d& is, const Vec3d& should, double tolerance = 1e-9) {
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(is[c], should[c], tolerance) << c;
}

TEST(GltfMaterials, MetalsAreMirrorsLobesOrDiffuseByTheirRoughness) {
  const Json gold{0.9, 0.7, 0.3, 1.0};
  const SceneMaterial smooth = material({{"baseColorFactor", gold}, {"roughnessFactor", 0}});
  EXPECT_EQ(smooth.kind, SurfaceKind::mirror);
  expect_near(smooth.specular, {0.9, 0.7, 0.3});
  const SceneMaterial rough = material({{"baseColorFactor", gold}, {"roughnessFactor", 0.5}});
  EXPECT_EQ(rough.kind, SurfaceKind::diffuse);
  expect_near(rough.specular, {0.9, 0.7, 0.3});
  expect_near(rough.diffuse, {0, 0, 0});
  EXPECT_NEAR(rough.exponent, 7.5, 1e-9);  // alpha 1/4: (16 - 1) / 2
  const SceneMaterial wide = material({{"baseColorFactor", gold}});
  expect_near(wide.diffuse, {0.9, 0.7, 0.3});
  expect_near(wide.specular, {0, 0, 0});
}

TEST(GltfMaterials, OthersReflectByTheirIndexWhereTheyAreSmooth) {
  const Json red{0.5, 0.1, 0.1, 1.0};
  const SceneMaterial smooth = material({{"baseColorFactor", red}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}});
  expect_near(smooth.specular, {0.04, 0.04, 0.04});
  expect_near(smooth.diffuse, {0.48, 0.096, 0.096});
  const SceneMaterial dense = material({{"baseColorFactor", red}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}},
                                       {{"extensions", {{"KHR_materials_ior", {{"ior", 3}}}}}});
  expect_near(dense.specular, {0.25, 0.25, 0.25});
  const SceneMaterial rough = material({{"baseColorFactor", red}, {"metallicFactor", 0}, {"roughnessFactor", 0.8}});
  expect_near(rough.diffuse, {0.5, 0.1, 0.1});
  EXPECT_FALSE(is_glossy(rough));
  const SceneMaterial half = material({{"baseColorFactor", red}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.5}});
  expect_near(half.specular, {0.27, 0.07, 0.07});
  expect_near(half.diffuse, {0.24, 0.048, 0.048});
}

TEST(GltfMaterials, GlassIsABodyByItsVolumeAndElseAPane) {
  const Json clear{{"KHR_materials_transmission", {{"transmissionFactor", 1}}}};
  const Json look{{"baseColorFactor", {0.9, 0.9, 0.9, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0}};
  const SceneMaterial pane = material(look, {{"extensions", clear}});
  EXPECT_EQ(pane.kind, SurfaceKind::glass);
  EXPECT_TRUE(pane.thin);
  expect_near(pane.transmittance, {0.9, 0.9, 0.9});
  Json body = clear;
  body["KHR_materials_volume"] = {
      {"thicknessFactor", 2}, {"attenuationDistance", 1}, {"attenuationColor", {0.5, 1, 1}}};
  body["KHR_materials_ior"] = {{"ior", 1.3}};
  const SceneMaterial block = material(look, {{"extensions", body}});
  EXPECT_FALSE(block.thin);
  EXPECT_EQ(block.refractive_index, 1.3);
  // Two crossings together leave 0.5^2 of red, and the colour twice.
  expect_near(block.transmittance, {0.45, 0.9, 0.9});
  const SceneMaterial film =
      material({{"baseColorFactor", {1, 0, 0, 0.25}}, {"metallicFactor", 0}}, {{"alphaMode", "BLEND"}});
  EXPECT_TRUE(film.thin);
  expect_near(film.transmittance, {1, 0.75, 0.75});
}

TEST(GltfMaterials, EmissionIsScaledByStrengthAndUnits) {
  GltfWriter file = gltf_square();
  file.json["materials"][0]["emissiveFactor"] = {1, 0.5, 0};
  file.json["materials"][0]["extensions"] = {{"KHR_materials_emissive_strength", {{"emissiveStrength", 683}}}};
  const Scene watt = load(file);
  expect_near(watt.materials[0].emission, {683, 341.5, 0});
  EXPECT_THAT(watt.warnings, Contains(HasSubstr("a.gltf: light is taken in watts")));
  SceneOptions options;
  options.gltf_units = GltfUnits::lumen;
  const Scene lumen = load(file, options);
  expect_near(lumen.materials[0].emission, {1, 0.5, 0});
  EXPECT_THAT(lumen.warnings, Contains(HasSubstr("light is taken in lumens")));
}

/// A bitmap of one row, two texels, 32 bits: half there in red, and wholly in green, by the alpha that is given.
std::string bitmap(std::uint8_t first, std::uint8_t second) {
  std::string tga(18, '\0');
  tga[2] = 2;
  tga[12] = 2;
  tga[14] = 1;
  tga[16] = 32;
  tga[17] = 8;
  for (const std::uint8_t value : std::initializer_list<std::uint8_t>{0, 0, 255, first, 0, 255, 0, second})
    tga.push_back(static_cast<char>(value));
  return tga;
}

GltfWriter textured(const std::string& image, const Json& info = {{"index", 0}}) {
  GltfWriter file = gltf_square();
  file.json["images"] = {{{"bufferView", file.view(image)}, {"mimeType", "image/tga"}}};
  file.json["textures"] = {{{"source", 0}}};
  file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = info;
  return file;
}

double whole_area(const Scene& scene) {
  double sum = 0;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) sum += area(scene, t);
  return sum;
}

TEST(GltfMaterials, TexturesLieUpwardsAndAreCutOutByTheMode) {
  GltfWriter opaque = textured(bitmap(100, 255));
  const Scene scene = load(opaque);
  ASSERT_EQ(scene.textures.size(), 1U);
  EXPECT_NEAR(whole_area(scene), 1, 1e-7);
  // The first vertex has v 1, which in glTF is the lowest row.
  const std::uint32_t first = scene.triangles[0].texture_points;
  EXPECT_EQ(scene.texture_points[first], (std::array<double, 2>{0, 0}));
  EXPECT_EQ(scene.texture_points[first + 2], (std::array<double, 2>{1, 1}));
  GltfWriter masked = textured(bitmap(100, 255));
  masked.json["materials"][0]["alphaMode"] = "MASK";
  EXPECT_NEAR(whole_area(load(masked)), 0.5, 1e-7);
  masked.json["materials"][0]["alphaCutoff"] = 0.3;  // 100/255 is more
  EXPECT_NEAR(whole_area(load(masked)), 1, 1e-7);
}

TEST(GltfMaterials, AMetalIsCutOutByATextureWhoseColoursItDoesNotShow) {
  GltfWriter file = textured(bitmap(100, 255));
  file.json["materials"][0]["alphaMode"] = "MASK";
  file.json["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 1;
  file.json["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0;
  const Scene scene = load(file);
  EXPECT_EQ(scene.materials[0].kind, SurfaceKind::mirror);
  EXPECT_NEAR(whole_area(scene), 0.5, 1e-7);
  expect_near(scene.materials[0].specular, {0.5, 0.5, 0}, 1e-9);  // of red and green
}

TEST(GltfMaterials, TextureTransformsTurnCounterClockwiseInTheImage) {
  const Json transform{{"offset", {0.5, 0}}, {"rotation", std::numbers::pi / 2}, {"scale", {2, 1}}};
  GltfWriter file = textured(bitmap(255, 255), {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}});
  const Scene scene = load(file);
  // u, v = 1, 1 (the second vertex): scaled 2, 1; turned 1, -2; moved 1.5, -2; upwards 1.5, 3. Whole periods fall away.
  const std::uint32_t first = scene.triangles[0].texture_points;
  EXPECT_NEAR(scene.texture_points[first + 1][0] - scene.texture_points[first][0], 0, 1e-9);
  EXPECT_NEAR(scene.texture_points[first + 1][1] - scene.texture_points[first][1], 2, 1e-9);
  EXPECT_NEAR(scene.texture_points[first + 2][0] - scene.texture_points[first + 1][0], -1, 1e-9);
}

TEST(GltfLights, HaveTheIntensityThatTheFileTells) {
  for (const std::string type : {"point", "spot"}) {
    GltfWriter file = gltf_square();
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", type}, {"name", "bulb"}, {"color", {1, 0.5, 0}}, {"intensity", 8}}};
    file.node({{"translation", {0, 0, 4}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    const Scene scene = load(file);
    double lit = 0;
    Vec3d radiance{};
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
      const SceneMaterial& material = scene.materials[scene.triangles[t].material];
      if (!emits(material)) continue;
      lit += area(scene, t);
      radiance = material.emission;
      EXPECT_EQ(material.name, "bulb");
    }
    // Flux: 4 pi I of a point; a disc's intensity on its axis is radiance times area.
    const double intensity = type == "point" ? radiance[0] * lit / 4 : radiance[0] * lit;
    EXPECT_NEAR(intensity, 8, 1e-6) << type;
    EXPECT_NEAR(radiance[1], radiance[0] / 2, 1e-9);
  }
}

/// [W/sr], summed over all lights: of points in all directions, of spots along their axes.
double whole_intensity(const Scene& scene, double share) {
  double sum = 0;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t)
    sum += scene.materials[scene.triangles[t].material].emission[0] * area(scene, t) * share;
  return sum;
}

// Exporters write one lamp for each bulb of a fitting.
TEST(GltfLights, AtOnePlaceAddUp) {
  GltfWriter file = gltf_square();
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 8}},
                                                              {{"type", "point"}, {"intensity", 2}},
                                                              {{"type", "spot"}, {"intensity", 3}}};
  const auto add = [&file](int light, double x) {
    file.node({{"translation", {x, 0, 4}}, {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
  };
  for (const int light : {0, 0, 1}) add(light, 0);
  const Scene scene = load(file);
  EXPECT_EQ(scene.triangles.size(), 22U);
  EXPECT_NEAR(whole_intensity(scene, 0.25), 18, 1e-6);
  EXPECT_THAT(scene.warnings, Not(Contains(HasSubstr("duplicate"))));
  // Nearer to each other than they are wide: both whole.
  add(0, 0.001);
  const Scene near = load(file);
  EXPECT_EQ(near.triangles.size(), 42U);
  EXPECT_NEAR(whole_intensity(near, 0.25), 26, 1e-6);
  vec::Box box;
  for (const SceneTriangle& triangle : near.triangles)
    for (const std::uint32_t p : triangle.position)
      if (near.positions[p][2] > 3) box.include(near.positions[p]);
  EXPECT_LT(box.extent()[0], 0.002);
  // A spot in a point is before it.
  GltfWriter spots = gltf_square();
  spots.json["extensions"] = file.json["extensions"];
  for (const int light : {0, 2, 2})
    spots.node({{"translation", {0, 0, 4}}, {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
  const Scene both = load(spots);
  EXPECT_EQ(both.triangles.size(), 28U);
  double lowest = 4;
  double of_spots = 4;
  for (const SceneTriangle& triangle : both.triangles) {
    for (const std::uint32_t p : triangle.position) {
      const double z = both.positions[p][2];
      if (z < 3) continue;
      double& least = both.materials[triangle.material].name == "light 2" ? of_spots : lowest;
      least = std::min(least, z);
    }
  }
  EXPECT_LT(of_spots, lowest);
}

GltfWriter with_cameras() {
  GltfWriter file = gltf_square();
  file.json["cameras"] = {{{"type", "perspective"}, {"name", "wide"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}},
                          {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 1}}}}};
  file.node({{"camera", 0}, {"translation", {0, 0, 7}}});
  file.node({{"camera", 1},
             {"name", "Door"},
             {"translation", {3, 0, 0}},
             {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}}});
  return file;
}

TEST(GltfCameras, TheFirstIsTakenOrTheOneThatIsNamed) {
  GltfWriter file = with_cameras();
  const Scene first = load(file);
  ASSERT_TRUE(first.camera);
  EXPECT_NEAR(first.camera->field_of_view_degrees, 180 / std::numbers::pi, 1e-9);
  expect_near(first.camera->eye, {0, 0, 7});
  expect_near(first.camera->look_at, {0, 0, 6});
  EXPECT_THAT(first.warnings, Contains(HasSubstr("the first of 2 cameras is taken")));
  SceneOptions options;
  options.camera_name = "Door";
  const Scene second = load(file, options);
  expect_near(second.camera->look_at, {2, 0, 0});
  options.camera_name = "Dor";
  EXPECT_THAT([&] { load(file, options); },
              testing::ThrowsMessage<InputError>(HasSubstr("did you mean 'Door'? There are 'wide', 'Door'")));
}

TEST(RoughSurface, ExponentsFallWithRoughness) {
  EXPECT_NEAR(lobe_exponent(1), 0, 1e-12);
  EXPECT_NEAR(lobe_exponent(0.1), 4999.5, 1e-6);
  EXPECT_EQ(lobe_exponent(0), lobe_exponent(0.1));
}

}  // namespace
}  // namespace torolux
