// SPDX-License-Identifier: MIT
// Proves: map_Kd is read as docs/materials.md says: which file, which way up, times Kd, at most 0.99; and what cannot
// be read is refused with its place.
#include <png.h>
#include <turbojpeg.h>

#include "host_tools/scene/textures.hpp"
#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
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

TEST(Texture, JpegOfFourInksIsReadToo) {
  // What inks leave of white, as Adobe's programs have it: 255 * 240 / 255, 100 * 240 / 255, 50 * 240 / 255.
  const std::vector<std::array<std::uint8_t, 4>> inks(64, {255, 100, 50, 240});
  unsigned char* out = nullptr;
  unsigned long size = 0;
  tjhandle writer = tjInitCompress();
  ASSERT_EQ(tjCompress2(writer, inks.data()->data(), 8, 0, 8, TJPF_CMYK, &out, &size, TJSAMP_444, 100, 0), 0);
  const std::string bytes(reinterpret_cast<const char*>(out), size);
  tjFree(out);
  tjDestroy(writer);
  const Scene scene = load_texts(texts("map_Kd my tiles.png\n", bytes), "a.obj");
  ASSERT_EQ(scene.textures[0].texels.size(), 64U);
  const std::array<int, 3> expected{240, 94, 47};
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(scene.textures[0].texels[9][c], expected[c], 3) << c;
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("four inks (CMYK)")));
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

TEST(Texture, GreyDeepAndTransparentPngsAreRead) {
  const std::array<std::uint8_t, 1> grey{77};
  const Scene scene = load_texts(texts("map_Kd my tiles.png\n", png(1, 1, grey.data(), PNG_FORMAT_GRAY)), "a.obj");
  EXPECT_EQ(scene.textures[0].texels[0], (std::array<std::uint8_t, 3>{77, 77, 77}));
  const std::array<std::uint8_t, 4> glassy{10, 20, 30, 140};
  const Scene seen = load_texts(texts("map_Kd my tiles.png\n", png(1, 1, glassy.data(), PNG_FORMAT_RGBA)), "a.obj");
  EXPECT_EQ(seen.textures[0].texels[0], (std::array<std::uint8_t, 3>{10, 20, 30}));
  EXPECT_THAT(seen.warnings, Contains(HasSubstr("alpha of a texture")));
  const std::array<std::uint16_t, 3> deep{65535, 32768, 0};  // linear: 0.5 is 188 in sRGB
  const Scene fine = load_texts(texts("map_Kd my tiles.png\n", png(1, 1, deep.data(), PNG_FORMAT_LINEAR_RGB)), "a.obj");
  EXPECT_EQ(fine.textures[0].texels[0][0], 255);
  EXPECT_NEAR(fine.textures[0].texels[0][1], 188, 2);  // libpng takes a power of 2.2 for sRGB
}

/// One row of pixels as they lie in a PNG of this depth and colour type, without any tag of their meaning.
std::string bare_png(std::uint32_t width, std::uint8_t depth, int colour_type, std::string row,
                     bool interlaced = false) {
  std::string bytes;
  png_structp writer = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(writer);
  const auto append = [](png_structp to, png_bytep data, std::size_t size) {
    static_cast<std::string*>(png_get_io_ptr(to))->append(reinterpret_cast<const char*>(data), size);
  };
  png_set_write_fn(writer, &bytes, append, nullptr);
  png_set_IHDR(writer, info, width, 1, depth, colour_type, interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  const std::array<png_color, 3> palette{{{136, 136, 136}, {255, 0, 0}, {0, 0, 0}}};
  if (colour_type == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(writer, info, palette.data(), 3);
  png_write_info(writer, info);
  auto* from = reinterpret_cast<png_bytep>(row.data());
  png_write_image(writer, &from);
  png_write_end(writer, info);
  png_destroy_write_struct(&writer, &info);
  return bytes;
}

TEST(Texture, PngsOfAllKindsWithoutTagsAreSrgb) {
  const std::array<std::uint8_t, 3> grey{136, 136, 136};  // 0x88
  struct Kind {
    std::uint8_t depth;
    int colour_type;
    std::string pixel;
  };
  for (const Kind& kind :
       {Kind{8, PNG_COLOR_TYPE_GRAY, "\x88"}, Kind{16, PNG_COLOR_TYPE_GRAY, "\x88\x88"},
        Kind{4, PNG_COLOR_TYPE_GRAY, "\x80"}, Kind{8, PNG_COLOR_TYPE_RGB, "\x88\x88\x88"},
        Kind{16, PNG_COLOR_TYPE_RGB, "\x88\x88\x88\x88\x88\x88"}, Kind{8, PNG_COLOR_TYPE_PALETTE, std::string(1, '\0')},
        Kind{2, PNG_COLOR_TYPE_PALETTE, std::string(1, '\0')}, Kind{8, PNG_COLOR_TYPE_GRAY_ALPHA, "\x88\xFF"},
        Kind{16, PNG_COLOR_TYPE_GRAY_ALPHA, "\x88\x88\xFF\xFF"}, Kind{8, PNG_COLOR_TYPE_RGB_ALPHA, "\x88\x88\x88\xFF"},
        Kind{16, PNG_COLOR_TYPE_RGB_ALPHA, "\x88\x88\x88\x88\x88\x88\xFF\xFF"}}) {
    for (const bool interlaced : {false, true}) {
      const std::string image = bare_png(1, kind.depth, kind.colour_type, kind.pixel, interlaced);
      const Scene scene = load_texts(texts("map_Kd my tiles.png\n", image), "a.obj");
      EXPECT_EQ(scene.textures[0].texels[0][0], kind.depth == 4 ? 136 : grey[0]);
      EXPECT_EQ(scene.textures[0].texels, Pixels(1, grey)) << int{kind.depth} << " bits, type " << kind.colour_type;
    }
  }
  const Scene bits = load_texts(texts("map_Kd my tiles.png\n", bare_png(2, 1, PNG_COLOR_TYPE_GRAY, "\x40")), "a.obj");
  EXPECT_EQ(bits.textures[0].texels, (Pixels{{0, 0, 0}, {255, 255, 255}}));
}

std::string little(std::uint32_t value, std::size_t bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes; ++i) text.push_back(static_cast<char>(value >> (8 * i)));
  return text;
}

/// 2 x 2, kFour, as blue, green, red from the lowest row up.
const std::string kLowestFirst(
    "\xFF\x00\x00"
    "\xFF\xFF\xFF"
    "\x00\x00\xFF"
    "\x00\xFF\x00",
    12);

TEST(Texture, TgaIsReadWhateverItsName) {
  const Pixels upwards{{0, 0, 255}, {255, 255, 255}, {255, 0, 0}, {0, 255, 0}};
  const auto header = [](char type, char bits, char descriptor) {
    return std::string(2, '\0') + type + std::string(9, '\0') + little(2, 2) + little(2, 2) + bits + descriptor;
  };
  const std::string plain = header(2, 24, 0) + kLowestFirst;
  EXPECT_EQ(load_texts(texts("map_Kd my tiles.png\n", plain), "a.obj").textures[0].texels, upwards);
  const std::string highest_first = header(2, 24, 0x20) + kLowestFirst.substr(6) + kLowestFirst.substr(0, 6);
  EXPECT_EQ(load_texts(texts("map_Kd my tiles.png\n", highest_first), "a.obj").textures[0].texels, upwards);
  const auto pixel = [](std::size_t i) { return kLowestFirst.substr(3 * i, 3); };
  const std::string rightmost_first = header(2, 24, 0x10) + pixel(1) + pixel(0) + pixel(3) + pixel(2);
  EXPECT_EQ(load_texts(texts("map_Kd my tiles.png\n", rightmost_first), "a.obj").textures[0].texels, upwards);
  std::string packed = header(10, 24, 0);  // run lengths: each pixel a run of one
  for (std::size_t i = 0; i < 12; i += 3) packed += '\x80' + kLowestFirst.substr(i, 3);
  EXPECT_EQ(load_texts(texts("map_Kd my tiles.png\n", packed), "a.obj").textures[0].texels, upwards);
  std::string glassy = header(2, 32, 8);
  for (std::size_t i = 0; i < 12; i += 3) glassy += kLowestFirst.substr(i, 3) + "\x80";
  const Scene seen = load_texts(texts("map_Kd my tiles.png\n", glassy), "a.obj");
  EXPECT_EQ(seen.textures[0].texels, upwards);
  EXPECT_THAT(seen.warnings, Contains(HasSubstr("alpha of a texture")));
  // The header tells that none of the 32 bits are alpha.
  std::string filled = glassy;
  filled[17] = 0;
  const Scene opaque = load_texts(texts("map_Kd my tiles.png\n", filled), "a.obj");
  EXPECT_EQ(opaque.textures[0].texels, upwards);
  EXPECT_THAT(opaque.warnings, Contains(HasSubstr("a TGA whose header tells of no alpha")));
  EXPECT_THAT(opaque.warnings, Not(Contains(HasSubstr("alpha of a texture"))));
  for (const std::string& image : {plain, packed, glassy})
    EXPECT_THAT(refusal(texts("map_Kd my tiles.png\n", image.substr(0, image.size() - 1)), "a.obj"),
                StartsWith("lib/a.mtl:2: the texture 'lib/my tiles.png' cannot be read: it is cut short"));
}

TEST(Texture, BmpIsRead) {
  const std::string rows =
      kLowestFirst.substr(0, 6) + std::string(2, '\0') + kLowestFirst.substr(6) + std::string(2, '\0');
  const std::string bmp = "BM" + little(54 + 16, 4) + little(0, 4) + little(54, 4) + little(40, 4) + little(2, 4) +
                          little(2, 4) + little(1, 2) + little(24, 2) + std::string(24, '\0') + rows;
  EXPECT_EQ(load_texts(texts("map_Kd my tiles.png\n", bmp), "a.obj").textures[0].texels,
            (Pixels{{0, 0, 255}, {255, 255, 255}, {255, 0, 0}, {0, 255, 0}}));
  std::string highest_first = bmp.substr(0, 54) + rows.substr(8) + rows.substr(0, 8);
  highest_first.replace(22, 4, "\xFE\xFF\xFF\xFF");  // -2 rows
  EXPECT_EQ(load_texts(texts("map_Kd my tiles.png\n", highest_first), "a.obj").textures[0].texels,
            (Pixels{{0, 0, 255}, {255, 255, 255}, {255, 0, 0}, {0, 255, 0}}));
  EXPECT_THAT(refusal(texts("map_Kd my tiles.png\n", bmp.substr(0, 20)), "a.obj"),
              StartsWith("lib/a.mtl:2: the texture 'lib/my tiles.png' cannot be read"));
  EXPECT_EQ(refusal(texts("map_Kd my tiles.png\n", bmp.substr(0, bmp.size() - 2)), "a.obj"), "(accepted)") << "filling";
  EXPECT_THAT(refusal(texts("map_Kd my tiles.png\n", bmp.substr(0, bmp.size() - 3)), "a.obj"), HasSubstr("cut short"));
  std::string huge = bmp;
  huge.replace(18, 8, little(100000, 4) + little(100000, 4));
  EXPECT_THAT(refusal(texts("map_Kd my tiles.png\n", huge), "a.obj"), StartsWith("lib/a.mtl:2: "));
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
