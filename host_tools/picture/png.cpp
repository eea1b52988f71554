// SPDX-License-Identifier: MIT
// PNG, in memory: a picture and an exposure enter, the bytes of a .png leave.
#include <png.h>

#include "emulator/errors.hpp"
#include "host_tools/picture/formats.hpp"
#include "host_tools/picture/tone_map.hpp"

namespace torolux {

std::vector<std::byte> encode_png(const Picture& picture, const ToneMapping& mapping) {
  const std::vector<std::uint8_t> pixels = tone_map(picture, mapping);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = picture.width;
  image.height = picture.height;
  image.format = PNG_FORMAT_RGB;
  std::vector<std::byte> bytes(PNG_IMAGE_PNG_SIZE_MAX(image));
  png_alloc_size_t size = bytes.size();
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, nullptr) == 0)
    throw InputError(std::string("the picture cannot be written as PNG: ") + image.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace torolux
