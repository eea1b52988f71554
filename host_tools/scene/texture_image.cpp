// SPDX-License-Identifier: MIT
// Tells kinds of picture apart and decodes them.
#include "host_tools/scene/texture_image.hpp"

#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <span>

#include "host_tools/scene/image_length.hpp"
#include "host_tools/scene/stb_image.hpp"

namespace torolux {
namespace {

/// Of a JPEG, within which its segments of programs lie if they are where they should be.
constexpr std::size_t kMostHeader = 65536;
constexpr std::string_view kAdobeSegment(
    "\xFF\xEE\0\x0E"
    "Adobe",
    9);  // APP14, its length

/// What begins with the rightmost pixel of each row.
template <class Texel>
void turn_rows(std::vector<Texel>& texels, std::size_t width) {
  for (auto row = texels.begin(); row != texels.end(); row += static_cast<std::ptrdiff_t>(width))
    std::reverse(row, row + static_cast<std::ptrdiff_t>(width));
}

struct Decoder {
  const std::string& file;
  const Place& place;
  Notices& notices;

  [[noreturn]] void damaged(const std::string& why) const {
    refuse(place, "the texture '" + file + "' cannot be read: " + why);
  }
  void check_size(std::uint64_t width, std::uint64_t height) const {
    if (width == 0 || height == 0) damaged("it has no pixels");
    if (width > kMostImageEdge || height > kMostImageEdge || width * height > kMostImagePixels)
      refuse(place, "the texture '" + file + "' has " + std::to_string(width) + " x " + std::to_string(height) +
                        " pixels; at most 16,777,216, on edges of at most 16,384, are read: make it smaller");
  }

  DecodedImage png(std::string_view bytes) const {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) damaged(image.message);
    const std::unique_ptr<png_image, decltype(&png_image_free)> keeper(&image, png_image_free);
    check_size(image.width, image.height);
    // libpng takes 16 bits without a tag for linear; the format's own word is that colours are sRGB unless they say so.
    image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
    image.format = PNG_FORMAT_RGBA;
    std::vector<std::array<std::uint8_t, 4>> pixels(std::size_t{image.width} * image.height);
    if (png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr) == 0) damaged(image.message);
    return colours(pixels, image.width, image.height);
  }

  /// Colours and alpha apart. Alpha that is zero everywhere is none: programs leave it unset.
  DecodedImage colours(std::span<const std::array<std::uint8_t, 4>> pixels, std::uint32_t width,
                       std::uint32_t height) const {
    DecodedImage image{{file, width, height, {}}, {}};
    image.colours.texels.reserve(pixels.size());
    for (const auto& pixel : pixels) image.colours.texels.push_back({pixel[0], pixel[1], pixel[2]});
    const bool opaque = std::ranges::all_of(pixels, [](const auto& pixel) { return pixel[3] == 255; });
    const bool unset = std::ranges::all_of(pixels, [](const auto& pixel) { return pixel[3] == 0; });
    if (unset) notices.note("the alpha of a texture is zero everywhere and not used", place);
    if (opaque || unset) return image;
    image.alpha.reserve(pixels.size());
    for (const auto& pixel : pixels) image.alpha.push_back(pixel[3]);
    return image;
  }

  DecodedImage tga_or_bmp(std::string_view bytes) const {
    const auto* from = reinterpret_cast<const stbi_uc*>(bytes.data());
    const auto size = static_cast<int>(bytes.size());  // at most kMostImageBytes
    int width = 0;
    int height = 0;
    int channels = 0;
    if (stbi_info_from_memory(from, size, &width, &height, &channels) == 0) damaged(stbi_failure_reason());
    const bool bmp = bytes.starts_with("BM");
    if (bmp && height < 0 && height != std::numeric_limits<int>::min()) height = -height;  // its highest row is first
    check_size(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height));
    const bool whole = (bmp ? bmp_is_whole : tga_is_whole)(bytes, static_cast<std::uint64_t>(width),
                                                           static_cast<std::uint64_t>(height));
    if (!whole) damaged("it is cut short");
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> read(
        stbi_load_from_memory(from, size, &width, &height, &channels, 4), stbi_image_free);
    if (!read) damaged(stbi_failure_reason());
    std::vector<std::array<std::uint8_t, 4>> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    std::memcpy(pixels.data(), read.get(), pixels.size() * 4);
    if (!bmp && tga_begins_right(bytes)) turn_rows(pixels, static_cast<std::size_t>(width));
    if (!bmp && !tga_has_alpha(bytes)) drop_alpha(pixels);
    return colours(pixels, static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height));
  }

  void drop_alpha(std::vector<std::array<std::uint8_t, 4>>& pixels) const {
    const auto opaque = [](const auto& pixel) { return pixel[3] == 255; };
    if (std::ranges::all_of(pixels, opaque)) return;
    notices.note("the fourth channel of a TGA whose header tells of no alpha is not used", place, file);
    for (auto& pixel : pixels) pixel[3] = 255;
  }

  DecodedImage jpeg(std::string_view bytes) const {
    const std::unique_ptr<void, decltype(&tjDestroy)> reader(tjInitDecompress(), tjDestroy);
    if (!reader) damaged("no JPEG decoder");
    const auto* from = reinterpret_cast<const unsigned char*>(bytes.data());
    const auto size = static_cast<unsigned long>(bytes.size());
    int width = 0;
    int height = 0;
    int sampling = 0;
    int space = 0;
    if (tjDecompressHeader3(reader.get(), from, size, &width, &height, &sampling, &space) != 0)
      damaged(tjGetErrorStr2(reader.get()));
    check_size(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height));
    SceneTexture texture{file, static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
    texture.texels.resize(std::size_t{texture.width} * texture.height);
    const auto decode = [&](unsigned char* pixels, int format) {
      if (tjDecompress2(reader.get(), from, size, pixels, width, 0, height, format, TJFLAG_ACCURATEDCT) == 0) return;
      const std::string why = tjGetErrorStr2(reader.get());
      if (tjGetErrorCode(reader.get()) != TJERR_WARNING || why.find("Premature end") != std::string::npos) damaged(why);
      notices.note("a JPEG is not quite as it should be, and read all the same", place, why);
    };
    if (space == TJCS_CMYK || space == TJCS_YCCK) {
      std::vector<std::array<std::uint8_t, 4>> inks(texture.texels.size());
      decode(inks.data()->data(), TJPF_CMYK);
      notices.note("a JPEG of four inks (CMYK) is read as what they leave of white", place, file);
      from_inks(inks, bytes.find(kAdobeSegment) < kMostHeader, texture.texels);
    } else {
      decode(texture.texels.data()->data(), TJPF_RGB);
    }
    return {std::move(texture), {}};
  }

  /// left_white: values are what an ink leaves, as Adobe's programs have them, who mark their files.
  static void from_inks(std::span<const std::array<std::uint8_t, 4>> inks, bool left_white,
                        std::vector<std::array<std::uint8_t, 3>>& texels) {
    for (std::size_t i = 0; i < inks.size(); ++i) {
      const auto left = [&](std::size_t ink) { return left_white ? inks[i][ink] : 255 - inks[i][ink]; };
      for (std::size_t c = 0; c < 3; ++c) texels[i][c] = static_cast<std::uint8_t>((left(c) * left(3) + 127) / 255);
    }
  }
};

/// By their first bytes, which TGA lacks: it is recognised by its header being one.
enum class ImageKind : std::uint8_t { png, jpeg, bmp, tga, unknown };

ImageKind kind_of(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG")) return ImageKind::png;
  if (bytes.starts_with("\xFF\xD8")) return ImageKind::jpeg;
  if (bytes.starts_with("BM")) return ImageKind::bmp;
  int width = 0;
  int height = 0;
  int channels = 0;
  const bool tga = stbi_info_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()),
                                         &width, &height, &channels) == 1;
  return tga ? ImageKind::tga : ImageKind::unknown;
}

/// Files begin with the highest row, texture points with the lowest.
template <class Texel>
void turn_upwards(std::vector<Texel>& texels, std::size_t width) {
  std::vector<Texel> upwards;
  upwards.reserve(texels.size());
  for (auto end = texels.end(); end != texels.begin(); end -= static_cast<std::ptrdiff_t>(width))
    upwards.insert(upwards.end(), end - static_cast<std::ptrdiff_t>(width), end);
  texels = std::move(upwards);
}

}  // namespace

DecodedImage decode_texture(std::string_view bytes, const std::string& file, const Place& place, Notices& notices) {
  const Decoder decoder{file, place, notices};
  const ImageKind kind = kind_of(bytes);
  if (kind == ImageKind::unknown)
    refuse(place,
           "the texture '" + file + "' is neither PNG, JPEG, TGA nor BMP; convert it, or take out what names it");
  DecodedImage image = kind == ImageKind::png    ? decoder.png(bytes)
                       : kind == ImageKind::jpeg ? decoder.jpeg(bytes)
                                                 : decoder.tga_or_bmp(bytes);
  turn_upwards(image.colours.texels, image.colours.width);
  turn_upwards(image.alpha, image.colours.width);
  return image;
}

}  // namespace torolux
