// SPDX-License-Identifier: MIT
// A scene with a texture, as texts: statements of its material and an image in, files out.
#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {

using Pixels = std::vector<std::array<std::uint8_t, 3>>;

/// Highest row first, as in files.
inline std::string png(std::uint32_t width, std::uint32_t height, const void* pixels,
                       png_uint_32 format = PNG_FORMAT_RGB) {
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
inline const Pixels kFour{{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}};

/// A triangle of a material of these statements, in line 2 and on of lib/a.mtl; the image is lib/my tiles.png.
inline Texts texts(const std::string& statements, const std::string& image = png(2, 2, kFour.data())) {
  return {{"a.obj", "mtllib lib/a.mtl\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl m\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1/1 2/2 3/3\n"},
          {"lib/a.mtl", "newmtl m\n" + statements},
          {"lib/my tiles.png", image}};
}

}  // namespace torolux
