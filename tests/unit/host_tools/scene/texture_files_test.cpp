// SPDX-License-Identifier: MIT
// Proves: textures of all kinds that PNG, JPEG, TGA and BMP have are read as what they mean, whatever their name; and
// what is cut short or of another kind is refused with its place.
#include <png.h>
#include <turbojpeg.h>

#include "tests/unit/host_tools/scene/texture_text.hpp"

namespace torolux {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(TextureFile, GreyDeepAndTransparentPngsAreRead) {
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

TEST(TextureFile, PngsOfAllKindsWithoutTagsAreSrgb) {
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

TEST(TextureFile, JpegIsReadToo) {
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

TEST(TextureFile, JpegOfFourInksIsReadToo) {
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

TEST(TextureFile, TgaIsReadWhateverItsName) {
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

TEST(TextureFile, BmpIsRead) {
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

}  // namespace
}  // namespace torolux
