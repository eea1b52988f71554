// SPDX-License-Identifier: MIT
// Proves: map_Kd is read as docs/materials.md says: which file, which way up, times Kd, at most 0.99; and what is wrong
// is refused with its place.
#include "host_tools/scene/textures.hpp"
#include "tests/unit/host_tools/scene/texture_text.hpp"

namespace torolux {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

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

// u and v are 2 x - 0.5: a strip of a quarter on each side lies beyond the edges, whose texels go on.
TEST(Texture, EdgesGoOnWhereItDoesNotRepeat) {
  Texts all = texts("map_Kd -clamp on -s 2 2 -o -0.5 -0.5 my tiles.png\n");
  const Scene scene = load_texts(all, "a.obj");
  double sum = 0;
  EXPECT_TRUE(scene.textures[0].clamped);
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    sum += area(scene, t);
    const SceneTriangle& triangle = scene.triangles[t];
    for (std::size_t axis = 0; axis < 2; ++axis) {
      double middle = 0;
      for (const std::uint32_t p : triangle.position) middle += (2 * scene.positions[p][axis] - 0.5) / 3;
      for (std::size_t i = 0; i < 3; ++i) {
        const double own = 2 * scene.positions[triangle.position[i]][axis] - 0.5;
        const double expected = middle < 0 ? 0 : middle > 1 ? 1 : own;
        EXPECT_NEAR(scene.texture_points[triangle.texture_points + i][axis], expected, 1e-6) << t << " " << axis;
      }
    }
  }
  EXPECT_NEAR(sum, 0.5, 1e-6);
  EXPECT_GT(scene.triangles.size(), 5U);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("a.obj:9: texture points (vt) beyond a texture with -clamp on")));
  // What lies within it, up to its edge, is not cut.
  EXPECT_EQ(load_texts(texts("map_Kd -clamp on my tiles.png\n"), "a.obj").triangles.size(), 1U);
}

TEST(Texture, BaseAndGainChangeItsValues) {
  Texts all = texts("map_Kd -cc on -mm 0.2 0.4 my tiles.png\nnewmtl n\nmap_Kd my tiles.png\n");
  all["a.obj"] += "v 0 0 5\nv 1 0 5\nv 0 1 5\nusemtl n\nf -3/1 -2/2 -1/3\n";
  const Scene scene = load_texts(all, "a.obj");
  ASSERT_EQ(scene.textures.size(), 2U);
  EXPECT_EQ(scene.textures[0].texels[0], (std::array<std::uint8_t, 3>{51, 51, 153}));
  EXPECT_EQ(scene.textures[1].texels[0], (std::array<std::uint8_t, 3>{0, 0, 255}));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("option -mm of map_Kd: an image's values are base + gain")));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("option -cc of map_Kd")));
  const Scene wild = load_texts(texts("map_Kd -mm 1e308 -1e308 my tiles.png\n"), "a.obj");
  EXPECT_EQ(wild.textures[0].texels[0], (std::array<std::uint8_t, 3>{255, 255, 0})) << "blue";
}

struct Written {
  const char* name;
  std::string arguments;
  std::string file;
  std::string told;  ///< of the one note; "": none
};

class FoundTexture : public testing::TestWithParam<Written> {};

TEST_P(FoundTexture, UnderWhatIsWritten) {
  Texts all = texts("map_Kd " + GetParam().arguments + "\n");
  all[GetParam().file] = all["lib/my tiles.png"];
  if (GetParam().file != "lib/my tiles.png") all.erase("lib/my tiles.png");
  const Scene scene = load_texts(all, "a.obj");
  ASSERT_EQ(scene.textures.size(), 1U);
  EXPECT_EQ(scene.textures[0].file, GetParam().file);
  std::vector<std::string> told = scene.warnings;
  std::erase_if(told, [](const std::string& note) {
    return note.find("map_Kd") == std::string::npos && note.find("texture is found") == std::string::npos;
  });
  if (GetParam().told.empty()) {
    EXPECT_THAT(told, testing::IsEmpty());
  } else {
    EXPECT_THAT(told, testing::ElementsAre(AllOf(StartsWith("lib/a.mtl:2: "), HasSubstr(GetParam().told))));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Names, FoundTexture,
    testing::Values(
        Written{"as_written", "my tiles.png", "lib/my tiles.png", ""},
        Written{"hash", "oak #2.png", "lib/oak #2.png", ""},
        Written{"comment", "my tiles.png # the floor", "lib/my tiles.png", "is 'lib/my tiles.png'"},
        Written{"beside_the_mesh", "my tiles.png", "my tiles.png", ""},
        Written{"quoted", "\"my tiles.png\"", "lib/my tiles.png", "is 'lib/my tiles.png'"},
        Written{"case", "My Tiles.PNG", "lib/my tiles.png", "is 'lib/my tiles.png'"},
        Written{"windows", "C:\\textures\\my tiles.png", "lib/my tiles.png", "is 'lib/my tiles.png'"},
        Written{"unix", "/Users/me/My Tiles.png", "my tiles.png", "is 'my tiles.png'"},
        Written{"folder_gone", "textures/tiles.png", "tiles.png", "is 'tiles.png'"},
        Written{"dash", "-tile.png", "lib/-tile.png", ""}, Written{"number", "-s 2 2 2 7", "lib/7", ""},
        Written{"unknown_option", "-projection 1 2 my tiles.png", "lib/my tiles.png", "-projection"},
        Written{"empty_scale", "-s my tiles.png", "lib/my tiles.png", "option -s of map_Kd without a value"},
        Written{"empty_boost", "-boost my tiles.png", "lib/my tiles.png", "option -boost of map_Kd is not used"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(Texture, UnknownOptionsMayHaveAWord) {
  const Scene scene = load_texts(texts("map_Kd -projection planar my tiles.png\n"), "a.obj");
  EXPECT_EQ(scene.textures[0].file, "lib/my tiles.png");
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("option -projection of map_Kd is not used")));
  for (const char* options : {"-s 1 1 1", "-s 2", "-mm 0 1", "-blendu on -o 0 0 0"}) {
    const Scene none = load_texts(texts("Kd 0.5\nmap_Kd " + std::string(options) + "\n"), "a.obj");
    EXPECT_EQ(none.materials[0].texture, kNoImage) << options;
    EXPECT_THAT(none.warnings, Contains(HasSubstr("without a file name: no texture"))) << options;
  }
  for (const char* options : {"-projection planar -o 0.5", "-colorspace sRGB", "-type sphere -blendu on"})
    EXPECT_EQ(load_texts(texts("map_Kd " + std::string(options) + " my tiles.png\n"), "a.obj").textures[0].file,
              "lib/my tiles.png");
  EXPECT_THAT(refusal(texts("map_Kd -colorspace linear my tiles.png\n"), "a.obj"), HasSubstr("option -colorspace"));
  const Scene behind = load_texts(texts("map_Kd my tiles.png -s 2 2 2\n"), "a.obj");
  EXPECT_EQ(behind.textures[0].file, "lib/my tiles.png");
  EXPECT_THAT(behind.warnings, Contains(HasSubstr("a texture is found under another name")));
}

TEST(Texture, ThatIsNowhereCanBeWhite) {
  MemoryFiles files(texts("Kd 0.25 0.25 0.25\nmap_Kd gone.png\n"));
  SceneOptions white;
  white.missing_materials = MissingMaterials::white;
  const Scene scene = load_scene_from(files, "a.obj", white);
  EXPECT_EQ(scene.materials[0].texture, kNoImage);
  EXPECT_EQ(scene.materials[0].diffuse, (Vec3d{0.25, 0.25, 0.25}));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("lib/a.mtl:3: there is no texture, white stands for it: 'gone.png'")));
}

TEST(Texture, PointsThatAreMissingAreRefusedWhereATextureNeedsThem) {
  Texts all = texts("map_Kd my tiles.png\n");
  all["a.obj"] += "f 1/9 2/9 3/9\n";
  EXPECT_THAT(refusal(all, "a.obj"), StartsWith("a.obj:10: a corner's texture point (vt) is not there"));
}

TEST(Texture, OneImageIsReadOnceAndOnlyWhereItIsUsed) {
  Texts two = texts("map_Kd my tiles.png\nnewmtl n\nmap_Kd my tiles.png\nnewmtl unused\nmap_Kd gone.png\n");
  two["a.obj"] += "v 0 0 5\nv 1 0 5\nv 0 1 5\nusemtl n\nf -3/1 -2/2 -1/3\n";
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
              HasSubstr("is neither PNG, JPEG, TGA nor BMP; convert it"));
  EXPECT_THAT(refusal(texts("map_Kd my tiles.png\n", png(2, 2, kFour.data()).substr(0, 50)), "a.obj"),
              StartsWith("lib/a.mtl:2: the texture 'lib/my tiles.png' cannot be read"));
  EXPECT_THAT(refusal(texts("map_Kd -imfchan r x.png\n"), "a.obj"), HasSubstr("option -imfchan of map_Kd"));
  EXPECT_EQ(refusal(texts("map_Kd -clamp off -mm 0 1 -t 0 0 0 my tiles.png\n"), "a.obj"), "(accepted)");
}

}  // namespace
}  // namespace torolux
