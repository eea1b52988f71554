// SPDX-License-Identifier: MIT
// One exposure for both pictures: an error of brightness must not vanish in an exposure of its own.
#include "host_tools/picture/visible_difference.hpp"

#include <cmath>

#include "host_tools/files/write_file.hpp"
#include "host_tools/picture/formats.hpp"
#include "host_tools/picture/tone_map.hpp"

namespace torolux {

VisibleDifference visible_difference(const Picture& picture, const Picture& reference, double pixels_per_degree) {
  const double factor = exposure_factor(reference, 0);
  const Picture a = shown(picture, factor, ToneCurve::filmic);
  const Picture b = shown(reference, factor, ToneCurve::filmic);
  VisibleDifference result;
  result.flip_map = flip(a, b, pixels_per_degree);
  result.flip = pool(result.flip_map);
  result.hdr_flip = pool(hdr_flip(picture, reference, pixels_per_degree));
  result.streaks = streaks(a, b);
  return result;
}

void write_flip_map(const Plane& flip_map, const std::filesystem::path& file) {
  if (holds_radiance(file)) {
    Picture picture{flip_map.width, flip_map.height, {}};
    picture.pixels.reserve(flip_map.values.size());
    for (const float value : flip_map.values) picture.pixels.push_back({value, value, value});
    write_picture(picture, file);
    return;
  }
  std::vector<std::uint8_t> bytes;
  bytes.reserve(flip_map.values.size() * 3);
  for (const float value : flip_map.values)
    bytes.insert(bytes.end(), 3, static_cast<std::uint8_t>(std::lround(255 * value)));
  write_file(file, encode_png(flip_map.width, flip_map.height, bytes));
}

}  // namespace torolux
