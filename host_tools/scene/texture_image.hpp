// SPDX-License-Identifier: MIT
// The bytes of an image file in, 8-bit sRGB colours out: PNG (libpng), JPEG (libjpeg-turbo), TGA and BMP (stb_image).
#pragma once

#include <string_view>

#include "host_tools/scene/files.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

/// 4096 x 4096, or as many in another shape.
inline constexpr std::uint64_t kMostImagePixels = std::uint64_t{1} << 24U;
inline constexpr std::uint32_t kMostImageEdge = 16384;

struct DecodedImage {
  SceneTexture colours;
  std::vector<std::uint8_t> alpha;  ///< of each texel, 0..255; empty: all are opaque
};

/// `file` is for the texture's name and messages; place: where it is named. Throws InputError: none of these kinds,
/// damaged, too large.
DecodedImage decode_texture(std::string_view bytes, const std::string& file, const Place& place, Notices& notices);

}  // namespace torolux
