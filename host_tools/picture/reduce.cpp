// SPDX-License-Identifier: MIT
// Exposure of the whole picture, tone curve, then means: so that highlights do not spread over their blocks.
#include "host_tools/picture/reduce.hpp"

#include <algorithm>

#include "host_tools/picture/tone_map.hpp"
#include "host_tools/picture/white_balance.hpp"

namespace torolux {
namespace {

/// Mean of the pixels of the block at (x, y), after the curve.
std::array<float, 3> block_mean(const Picture& picture, std::uint32_t x, std::uint32_t y, std::uint32_t k,
                                double factor, ToneCurve curve) {
  std::array<float, 3> sum{};
  const std::uint32_t x_end = std::min(picture.width, x + k);
  const std::uint32_t y_end = std::min(picture.height, y + k);
  for (std::uint32_t v = y; v < y_end; ++v) {
    for (std::uint32_t u = x; u < x_end; ++u) {
      const auto& pixel = picture.pixels[std::size_t{v} * picture.width + u];
      std::array<float, 3> exposed{};
      for (std::size_t c = 0; c < 3; ++c) exposed[c] = static_cast<float>(double{pixel[c]} * factor);
      const auto shown = compress(exposed, curve);
      for (std::size_t c = 0; c < 3; ++c) sum[c] += shown[c];
    }
  }
  const auto count = static_cast<float>((x_end - x) * (y_end - y));
  return {sum[0] / count, sum[1] / count, sum[2] / count};
}

}  // namespace

ReducedPicture reduce(const Picture& picture, const ToneMapping& mapping, std::uint32_t most_edge) {
  if (const auto changed = balanced(picture, mapping.white))
    return reduce(*changed, without_balance(mapping), most_edge);
  const std::uint32_t edge = std::max(picture.width, picture.height);
  const std::uint32_t k = std::max(1U, (edge + most_edge - 1) / most_edge);
  if (k == 1) return {picture.width, picture.height, tone_map(picture, mapping)};
  ReducedPicture small{(picture.width + k - 1) / k, (picture.height + k - 1) / k, {}};
  const double factor = exposure_factor(picture, mapping.exposure_ev);
  small.bytes.reserve(std::size_t{3} * small.width * small.height);
  for (std::uint32_t y = 0; y < small.height; ++y) {
    for (std::uint32_t x = 0; x < small.width; ++x) {
      for (const float channel : block_mean(picture, x * k, y * k, k, factor, mapping.curve))
        small.bytes.push_back(to_srgb(channel));
    }
  }
  return small;
}

}  // namespace torolux
