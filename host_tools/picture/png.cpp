// SPDX-License-Identifier: MIT
// PNG, in memory: a picture and an exposure enter, the bytes of a .png leave.
#include <png.h>

#include "emulator/errors.hpp"
#include "host_tools/picture/formats.hpp"
#include "host_tools/picture/tone_map.hpp"

namespace torolux {

std::vector<std::byte> encode_png(const Picture& picture, const ToneMapping& mapping) {
  return encode_png(picture.width, picture.height, tone_map(picture, mapping));
}

std::vector<std::byte> encode_png(std::uint32_t width, std::uint32_t height, std::span<const std::uint8_t> bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = width;
  image.height = height;
  image.format = PNG_FORMAT_RGB;
  std::vector<std::byte> file(PNG_IMAGE_PNG_SIZE_MAX(image));
  png_alloc_size_t size = file.size();
  if (png_image_write_to_memory(&image, file.data(), &size, 0, bytes.data(), 0, nullptr) == 0)
    throw InputError(std::string("the picture cannot be written as PNG: ") + image.message);
  file.resize(size);
  return file;
}

}  // namespace torolux
