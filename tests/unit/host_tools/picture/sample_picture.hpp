// SPDX-License-Identifier: MIT
// A picture for tests.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/protocol/random.hpp"
#include "host_tools/picture/picture.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::testing_support {

/// No two values alike, over ten orders of magnitude, 0 among them.
inline Picture sample_picture(std::uint32_t width, std::uint32_t height) {
  Picture picture{width, height, {}};
  for (std::uint32_t i = 0; i < width * height; ++i) {
    std::array<float, 3> pixel{};
    for (std::uint32_t c = 0; c < 3; ++c) {
      const float u = protocol::uniform_float(protocol::hash_combine(i, c));
      pixel[c] = u * u * u * 1e5F;
    }
    picture.pixels.push_back(pixel);
  }
  picture.pixels[0] = {0, 0, 0};
  return picture;
}

}  // namespace torolux::testing_support
