// SPDX-License-Identifier: MIT
// See texture_image.hpp.
#include "host_tools/scene/texture_image.hpp"

#include <png.h>
#include <turbojpeg.h>

#include <memory>

namespace torolux {
namespace {

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

  SceneTexture png(std::string_view bytes) const {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) damaged(image.message);
    const std::unique_ptr<png_image, decltype(&png_image_free)> keeper(&image, png_image_free);
    check_size(image.width, image.height);
    image.format = PNG_FORMAT_RGBA;
    std::vector<std::array<std::uint8_t, 4>> pixels(std::size_t{image.width} * image.height);
    if (png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr) == 0) damaged(image.message);
    SceneTexture texture{file, image.width, image.height, {}};
    texture.texels.reserve(pixels.size());
    bool opaque = true;
    for (const auto& pixel : pixels) {
      texture.texels.push_back({pixel[0], pixel[1], pixel[2]});
      opaque = opaque && pixel[3] == 255;
    }
    if (!opaque) notices.note("the transparency of a texture is not used", place);
    return texture;
  }

  SceneTexture jpeg(std::string_view bytes) const {
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
    if (space == TJCS_CMYK || space == TJCS_YCCK) damaged("its colours are CMYK; save it in RGB");
    SceneTexture texture{file, static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}};
    texture.texels.resize(std::size_t{texture.width} * texture.height);
    if (tjDecompress2(reader.get(), from, size, texture.texels.data()->data(), width, 0, height, TJPF_RGB,
                      TJFLAG_ACCURATEDCT) != 0)
      damaged(tjGetErrorStr2(reader.get()));
    return texture;
  }
};

/// Files begin with the highest row, texture points with the lowest.
void turn_upwards(SceneTexture& texture) {
  std::vector<std::array<std::uint8_t, 3>> upwards;
  upwards.reserve(texture.texels.size());
  for (std::size_t row = texture.height; row-- > 0;) {
    const auto from = texture.texels.begin() + static_cast<std::ptrdiff_t>(row * texture.width);
    upwards.insert(upwards.end(), from, from + texture.width);
  }
  texture.texels = std::move(upwards);
}

}  // namespace

SceneTexture decode_texture(std::string_view bytes, const std::string& file, const Place& place, Notices& notices) {
  const Decoder decoder{file, place, notices};
  const bool png = bytes.starts_with("\x89PNG");
  if (!png && !bytes.starts_with("\xFF\xD8"))
    refuse(place, "the texture '" + file + "' is neither PNG nor JPEG; convert it, or take the map_Kd line out");
  SceneTexture texture = png ? decoder.png(bytes) : decoder.jpeg(bytes);
  turn_upwards(texture);
  return texture;
}

}  // namespace torolux
