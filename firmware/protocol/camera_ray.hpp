// SPDX-License-Identifier: MIT
// Camera rays: enters a pixel and one of its samples, leaves a direction. By integers and single floats alone, no call
// of a library but sqrt, so that the host and every PE make the same rays to the last bit.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "firmware/protocol/random.hpp"
#include "firmware/protocol/records.hpp"

namespace torolux::protocol {

inline constexpr std::uint32_t kMostPictureEdge = 32768;   ///< [pixels]
inline constexpr std::uint32_t kMostPixelSamples = 65536;  ///< counted in 16 bits
inline constexpr std::uint32_t kMostFilterBits = 16;

/// What all rays of a picture share. The host computes it in double and rounds each number once.
struct CameraView {
  Vec3f eye;                    ///< normalised scene space
  Vec3f forward;                ///< unit length
  Vec3f right, down;            ///< a pixel's width and height at distance 1 from the eye
  std::uint32_t width, height;  ///< of the picture [pixels], 1..kMostPictureEdge
  std::uint32_t samples;        ///< of a pixel, 1..kMostPixelSamples
  std::uint32_t seed;
  std::uint32_t filter_bits;  ///< 1..kMostFilterBits: the filter's table has 2^filter_bits + 1 entries
};
static_assert(sizeof(CameraView) == 68);

/// A sample's place in the pattern that all pixels have, x rightwards, y downwards [2^-32 of the pixel's square].
struct SamplePlace {
  std::uint32_t x, y;
};

/// What the samples of one pixel share.
struct CameraPixel {
  float x, y;                      ///< from the picture's middle to the pixel's [pixels]
  std::uint32_t moved_x, moved_y;  ///< of the pattern, which goes round [2^-32 of the pixel's square]
  std::uint32_t number;            ///< row * width + column
  std::uint32_t key;               ///< hash of (seed, number)
};

/// Each pixel has the same pattern, moved by a part of the pixel's square that neighbours share out evenly (M. Roberts,
/// "The unreasonable effectiveness of quasirandom sequences", 2018): were it not moved, an edge along a row of pixels
/// would be wrong by the same in all of them. column < width, row < height; row 0 is on top.
constexpr CameraPixel camera_pixel(const CameraView& view, std::uint32_t column, std::uint32_t row) {
  // Powers of the reciprocals of the numbers that solve x^3 = x + 1 and x^4 = x + 1.
  constexpr auto of_turn = [](double part) { return static_cast<std::uint32_t>(part * 0x1p32); };
  constexpr std::uint32_t x_by_column = of_turn(0.7548776662466927);
  constexpr std::uint32_t x_by_row = of_turn(0.5698402909980532);
  constexpr std::uint32_t y_by_column = of_turn(0.8191725133961645);
  constexpr std::uint32_t y_by_row = of_turn(0.6710436067037893);
  const auto from_middle = [](std::uint32_t at, std::uint32_t count) {
    return static_cast<float>(static_cast<std::int32_t>(2U * at + 1U - count)) * 0.5F;  // exact
  };
  const std::uint32_t number = row * view.width + column;
  return {from_middle(column, view.width),
          from_middle(row, view.height),
          x_by_column * column + x_by_row * row,
          y_by_column * column + y_by_row * row,
          number,
          hash_combine(view.seed, number)};
}

/// Distance from the pixel's middle below which `part` of the filter lies [pixels]; part: in units of 2^-32. table:
/// these distances at equal steps of the part, from nothing to all, 2^bits + 1 of them.
constexpr float filter_distance(std::span<const float> table, std::uint32_t bits, std::uint32_t part) {
  const std::uint32_t step = part >> (32U - bits);
  const float within = static_cast<float>(static_cast<std::int32_t>((part << bits) >> 8U)) * 0x1p-24F;
  return table[step] + (table[step + 1U] - table[step]) * within;
}

/// Where one sample of a pixel looks, from the eye: unit length. Filter importance sampling (Ernst, Stamminger &
/// Greiner 2006): the sample is drawn from the filter, so all weigh the same. place: the sample's; table: as above.
inline Vec3f camera_direction(const CameraView& view, const CameraPixel& pixel, const SamplePlace& place,
                              std::span<const float> table) {
  const float x = pixel.x + filter_distance(table, view.filter_bits, place.x + pixel.moved_x);
  const float y = pixel.y + filter_distance(table, view.filter_bits, place.y + pixel.moved_y);
  // Written out: as loops over arrays they would cost memory accesses on a PE.
  const float way_x = view.forward[0] + (view.right[0] * x + view.down[0] * y);
  const float way_y = view.forward[1] + (view.right[1] * x + view.down[1] * y);
  const float way_z = view.forward[2] + (view.right[2] * x + view.down[2] * y);
  const float inverse = 1.0F / std::sqrt(way_x * way_x + way_y * way_y + way_z * way_z);
  return {way_x * inverse, way_y * inverse, way_z * inverse};
}

/// Of the random numbers on the sample's path.
constexpr std::uint32_t camera_key(const CameraPixel& pixel, std::uint32_t sample) {
  return hash_combine(pixel.key, sample);
}

}  // namespace torolux::protocol
