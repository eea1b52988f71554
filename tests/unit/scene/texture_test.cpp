// SPDX-License-Identifier: MIT
// Proves: map_Kd is read as docs/materials.md says: which file, which way up, times Kd, at most 0.99; and what cannot
// be read is refused with its place.
#include <png.h>
#include <turbojpeg.h>

#include "host_tools/scene/textures.hpp"
#include "tests/unit/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

using Pixels = std::vector<std::array<std::uint8_t, 3>>;

/// Highest row first, as in files.
std::string png(std::uint32_t width, std::uint32_t height, const void* pixels, png_uint_32 format = PNG_FORMAT_RGB) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = format;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string bytes(size, '\0');
  EXPECT_NE(png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels, 0, nullptr), 0);
  bytes.resize(size);
  return bytes;
}

/// Red and green above, blue and white below.
const Pixels kFour{{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}};

Texts texts(const std::string& statements, const std::string& image = png(2, 2, kFour.data())) {
  return {{"a.obj", "mtllib lib/a.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl m\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1/1 2/2 3/3\n"},
          {"lib/a.mtl", "newmtl m\n" + statements},
          {"lib/my tiles.png", image}};
}

TEST(Texture, IsReadFromTheLowestRowUp) {
  const Scene scene = load_texts(texts("Kd 0.5 0.5 0.5\nmap_Kd my tiles.png\n"), "a.obj");
  ASSERT_EQ(scene.textures.size(), 1U);
  EXPECT_EQ(scene.materials[0].texture, 0U);
  EXPECT_EQ(scene.textures[0].width, 2U);
  EXPECT_EQ(scene.textures[0].height, 2U);
  EXPECT_EQ(scene.textures[0].texels, (Pixels{{0, 0, 255}, {255, 255, 255}, {255, 0, 0}, {0, 255, 0}}));
  EXPECT_EQ(scene.materials[0].diffuse, (Vec3d{0.5, 0.5, 0.5}));
  ASSERT_EQ(scene.triangles[0].texture_points, 0U);
  EXPECT_EQ(scene.texture_points[1], (std::array<double, 2>{1, 0}));
  EXPECT_EQ(scene.texture_points[2], (std::array<double, 2>{1, 1}));
  EXPECT_THAT(scene.warnings, testing::Not(Contains(HasSubstr("texture"))));
}

TEST(Texture, BackslashesAndOptionsBeforeTheNameAreRead) {
  const Scene scene =
      load_texts(texts("map_Kd -blendu on -s 2 3 -o 0.25 .\\my tiles.png\n"), "a.obj");  // -o: 0.25, and 0 for v
  EXPECT_EQ(scene.texture_points[0], (std::array<double, 2>{0.25, 0}));
  EXPECT_EQ(scene.texture_points[2], (std::array<double, 2>{2.25, 3}));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("lib/a.mtl:2: option -blendu of map_Kd is not used")));
}

TEST(Texture, PointsAreMovedByWholePeriods) {
  Texts moved = texts("map_Kd -o -7.5 1000.25 my tiles.png\n");
  const Scene scene = load_texts(moved, "a.obj");
  EXPECT_EQ(scene.texture_points[0], (std::array<double, 2>{0.5, 0.25}));
  EXPECT_EQ(scene.texture_points[2], (std::array<double, 2>{1.5, 1.25}));
  EXPECT_THAT(refusal(texts("map_Kd -s 2000001 my tiles.png\n"), "a.obj"),
              StartsWith("a.obj:9: a texture repeats more than 1,000,000 times"));
}

TEST(Texture, PointsTurnWithTheirTriangle) {
  Texts flipped = texts("map_Kd my tiles.png\n");
  flipped["s.toml"] = "[[mesh]]\nfile = 'a.obj'\nflip = true\n";
  const Scene scene = load_texts(flipped, "s.toml");
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d& at = scene.positions[scene.triangles[0].position[i]];
    EXPECT_EQ(scene.texture_points[i], (std::array<double, 2>{at[0], at[1]})) << i;
  }
}

TEST(Texture, TimesKdAndKsStaysBelowOne) {
  // Without Kd, and where it is black: times one, and then 0.99.
  EXPECT_NEAR(load_texts(texts("map_Kd my tiles.png\n"), "a.obj").materials[0].diffuse[0], 0.99, 1e-12);
  const Scene black = load_texts(texts("Kd 0 0 0\nmap_Kd my tiles.png\n"), "a.obj");
  EXPECT_NEAR(black.materials[0].diffuse[1], 0.99, 1e-12);
  EXPECT_THAT(black.warnings, Contains(HasSubstr("times Kd 0 would be black")));
  const SceneMaterial glossy =
      load_texts(texts("Kd 1 1 1\nKs 0.5\nNs 5\nillum 2\nmap_Kd my tiles.png\n"), "a.obj").materials[0];
  EXPECT_NEAR(glossy.diffuse[0], 0.66, 1e-12);
  EXPECT_NEAR(glossy.specular[0], 0.33, 1e-12);
  const Pixels grey(1, {188, 188, 188});  // 0.503 linear: no need to scale Kd 1
  const Scene dark = load_texts(texts("Kd 1 1 1\nmap_Kd my tiles.png\n", png(1, 1, grey.data())), "a.obj");
  EXPECT_EQ(dark.materials[0].diffuse, (Vec3d{1, 1, 1}));
  EXPECT_NEAR(linear_of_srgb(188), 0.503, 0.0005);  // IEC 61966-2-1: 0.5029
  EXPECT_EQ(linear_of_srgb(0), 0);
  EXPECT_DOUBLE_EQ(linear_of_srgb(255), 1);
}

TEST(Texture, JpegIsReadToo) {
  const Pixels red(64, {200, 40, 30});
  unsigned char* out = nullptr;
  unsigned long size = 0;
  tjhandle writer = tjInitCompress();
  ASSERT_EQ(tjCompress2(writer, red.data()->data(), 8, 0, 8, TJPF_RGB, &out, &size, TJSAMP_444, 95, 0), 0);
  const std::string bytes(reinterpret_cast<const char*>(out), size);
  tjFree(out);
  tjDestroy(writer);
  const Scene scene = load_texts(texts("map_Kd my tiles.png\n", bytes), "a.obj");
  ASSERT_EQ(scene.textures[0].texels.size(), 64U);
  EXPECT_NEAR(scene.textures[0].texels[9][0], 200, 3);
  EXPECT_NEAR(scene.textures[0].texels[9][2], 30, 3);
  EXPECT_THAT(refusal(texts("map_Kd my tiles.png\n", bytes.substr(0, 40)), "a.obj"),
              StartsWith("lib/a.mtl:2: the texture 'lib/my tiles.png' cannot be read"));
}

TEST(Texture, GreyDeepAndTransparentPngsAreRead) {
  const std::array<std::uint8_t, 1> grey{77};
  const Scene scene = load_texts(texts("map_Kd my tiles.png\n", png(1, 1, grey.data(), PNG_FORMAT_GRAY)), "a.obj");
  EXPECT_EQ(scene.textures[0].texels[0], (std::array<std::uint8_t, 3>{77, 77, 77}));
  const std::array<std::uint8_t, 4> glassy{10, 20, 30, 40};
  const Scene seen = load_texts(texts("map_Kd my tiles.png\n", png(1, 1, glassy.data(), PNG_FORMAT_RGBA)), "a.obj");
  EXPECT_EQ(seen.textures[0].texels[0], (std::array<std::uint8_t, 3>{10, 20, 30}));
  EXPECT_THAT(seen.warnings, Contains(HasSubstr("transparency of a texture")));
  const std::array<std::uint16_t, 3> deep{65535, 32768, 0};  // linear: 0.5 is 188 in sRGB
  const Scene fine = load_texts(texts("map_Kd my tiles.png\n", png(1, 1, deep.data(), PNG_FORMAT_LINEAR_RGB)), "a.obj");
  EXPECT_EQ(fine.textures[0].texels[0][0], 255);
  EXPECT_NEAR(fine.textures[0].texels[0][1], 188, 2);  // libpng takes a power of 2.2 for sRGB
}

TEST(Texture, OneImageIsReadOnceAndOnlyWhereItIsUsed) {
  Texts two = texts("map_Kd my tiles.png\nnewmtl n\nmap_Kd my tiles.png\nnewmtl unused\nmap_Kd gone.png\n");
  two["a.obj"] += "usemtl n\nf 3/1 2/2 1/3\n";
  const Scene scene = load_texts(two, "a.obj");
  EXPECT_EQ(scene.textures.size(), 1U);
  EXPECT_EQ(scene.materials[1].texture, 0U);
  EXPECT_EQ(scene.triangles[1].texture_points, 3U);
  // A material that scene.toml makes diffuse has no texture left.
  Texts plain = texts("map_Kd gone.png\n");
  plain["s.toml"] = "[[mesh]]\nfile = 'a.obj'\n[material.m]\ndiffuse = 0.5\n";
  EXPECT_EQ(load_texts(plain, "s.toml").materials[0].texture, kNoImage);
}

TEST(Texture, FacesWithoutPointsAreTold) {
  Texts bare = texts("map_Kd my tiles.png\n");
  bare["a.obj"] += "f 3/1 2 1\n";
  const Scene scene = load_texts(bare, "a.obj");
  EXPECT_THAT(scene.warnings, Contains(StartsWith("a.obj:10: a face of a textured material without texture points")));
  EXPECT_EQ(scene.texture_points[5], (std::array<double, 2>{0, 0}));
}

TEST(Texture, RefusalsNameFileLineAndWhatToDo) {
  EXPECT_THAT(refusal(texts("Kd 1 1 1\nmap_Kd gone.png\n"), "a.obj"),
              StartsWith("lib/a.mtl:3: there is no texture 'lib/gone.png'; put it there"));
  EXPECT_THAT(refusal(texts("map_Kd my tiles.png\n", "GIF89a"), "a.obj"),
              HasSubstr("is neither PNG nor JPEG; convert it"));
  EXPECT_THAT(refusal(texts("map_Kd my tiles.png\n", png(2, 2, kFour.data()).substr(0, 50)), "a.obj"),
              StartsWith("lib/a.mtl:2: the texture 'lib/my tiles.png' cannot be read"));
  EXPECT_THAT(refusal(texts("map_Kd -s 2 2 -clamp on my tiles.png\n"), "a.obj"),
              HasSubstr("lies beyond the edge of a texture with -clamp on"));
  EXPECT_EQ(refusal(texts("map_Kd -clamp on my tiles.png\n"), "a.obj"), "(accepted)");
  EXPECT_THAT(refusal(texts("map_Kd -mm 0.1 2 x.png\n"), "a.obj"), HasSubstr("option -mm of map_Kd"));
  EXPECT_THAT(refusal(texts("map_Kd -imfchan r x.png\n"), "a.obj"), HasSubstr("option -imfchan of map_Kd"));
  EXPECT_EQ(refusal(texts("map_Kd -clamp off -mm 0 1 -t 0 0 0 my tiles.png\n"), "a.obj"), "(accepted)");
}

}  // namespace
}  // namespace torolux
