// SPDX-License-Identifier: MIT
// Guesses the light where it is not told, and changes each pixel.
#include "host_tools/picture/white_balance.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "host_tools/colour/white_point.hpp"
#include "host_tools/picture/tone_map.hpp"

namespace torolux {
namespace {

/// Of a channel, of the greatest one: a picture of one pure colour is no light of that colour.
constexpr double kLeastChannel = 0.05;

}  // namespace

std::array<double, 3> light_colour(const Picture& picture) {
  const std::vector<double> measured = measured_luminances(picture);
  if (measured.empty()) return {1, 1, 1};
  const double lowest = measured.front();
  const double highest = measured.back();
  std::array<double, 3> sum{};
  for (const auto& pixel : picture.pixels) {
    const double bright = luminance(pixel);
    if (!(bright >= lowest && bright <= highest)) continue;
    for (std::size_t c = 0; c < 3; ++c) sum[c] += std::pow(std::max(double{pixel[c]} / highest, 0.0), 6);
  }
  const double most = std::max({sum[0], sum[1], sum[2]});
  if (!(most > 0)) return {1, 1, 1};
  std::array<double, 3> light{};
  for (std::size_t c = 0; c < 3; ++c) light[c] = std::max(std::pow(sum[c] / most, 1.0 / 6), kLeastChannel);
  return light;
}

std::optional<Picture> balanced(const Picture& picture, const WhiteBalance& white) {
  if (white.kind == WhiteBalance::Kind::off) return std::nullopt;
  const bool guessed = white.kind == WhiteBalance::Kind::automatic;
  const ColourMatrix change = adaptation_to(guessed ? light_colour(picture) : light_of(white.kelvin));
  Picture result{picture.width, picture.height, {}};
  result.pixels.reserve(picture.pixels.size());
  for (const auto& pixel : picture.pixels) {
    const auto colour = changed(change, {double{pixel[0]}, double{pixel[1]}, double{pixel[2]}});
    result.pixels.push_back(
        {static_cast<float>(colour[0]), static_cast<float>(colour[1]), static_cast<float>(colour[2])});
  }
  return result;
}

}  // namespace torolux
