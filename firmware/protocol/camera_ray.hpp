// SPDX-License-Identifier: MIT
// Camera rays: enters a pixel and one of its samples, leaves a ray. By integers and single floats alone, no call
// of a library but sqrt, so that the host and every PE make the same rays to the last bit.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "firmware/protocol/picture_order.hpp"
#include "firmware/protocol/random.hpp"
#include "firmware/protocol/records.hpp"
#include "firmware/protocol/sine_cosine.hpp"
#include "firmware/protocol/stratified.hpp"

namespace torolux::protocol {

inline constexpr std::uint32_t kMostPictureEdge = 32768;   ///< [pixels]
inline constexpr std::uint32_t kMostPixelSamples = 65536;  ///< counted in 16 bits
inline constexpr std::uint32_t kMostFilterBits = 16;

/// What all rays of a picture share. The host computes it in double and rounds each number once.
struct CameraView {
  Vec3f eye;                    ///< normalised scene space
  Vec3f forward;                ///< unit length
  Vec3f right, down;            ///< a pixel's width and height at distance 1 from the eye
  Vec3f lens_right, lens_down;  ///< the lens's radius, across the picture and down
  float inverse_focus;          ///< 1 / distance from the eye, along `forward`, of the plane that is sharp; 0: no lens
  std::uint32_t width, height;  ///< of the picture [pixels], 1..kMostPictureEdge
  std::uint32_t samples;        ///< of a pixel, 1..kMostPixelSamples
  std::uint32_t seed;
  std::uint32_t filter_bits;  ///< 1..kMostFilterBits: the filter's table has 2^filter_bits + 1 entries
};
static_assert(sizeof(CameraView) == 96);

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
  std::uint32_t first_place;       ///< of its samples in the picture (picture_order.hpp)
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
          hash_combine(view.seed, number),
          place_in_picture(column, row, 0, view.samples)};
}

/// Distance from the pixel's middle below which `part` of the filter lies [pixels]; part: in units of 2^-32. table:
/// these distances at equal steps of the part, from nothing to all, 2^bits + 1 of them.
constexpr float filter_distance(std::span<const float> table, std::uint32_t bits, std::uint32_t part) {
  const std::uint32_t step = part >> (32U - bits);
  const float within = static_cast<float>(static_cast<std::int32_t>((part << bits) >> 8U)) * 0x1p-24F;
  return table[step] + (table[step + 1U] - table[step]) * within;
}

/// From the eye to where one sample of a pixel looks, at distance 1 along `forward`. Filter importance sampling (Ernst,
/// Stamminger & Greiner 2006): the sample is drawn from the filter, so all weigh the same. place: the sample's; table:
/// as above.
inline Vec3f camera_way(const CameraView& view, const CameraPixel& pixel, const SamplePlace& place,
                        std::span<const float> table) {
  const float x = pixel.x + filter_distance(table, view.filter_bits, place.x + pixel.moved_x);
  const float y = pixel.y + filter_distance(table, view.filter_bits, place.y + pixel.moved_y);
  // Written out: as loops over arrays they would cost memory accesses on a PE.
  return {view.forward[0] + (view.right[0] * x + view.down[0] * y),
          view.forward[1] + (view.right[1] * x + view.down[1] * y),
          view.forward[2] + (view.right[2] * x + view.down[2] * y)};
}

inline Vec3f unit_way(const Vec3f& way) {
  const float inverse = 1.0F / std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
  return {way[0] * inverse, way[1] * inverse, way[2] * inverse};
}

/// The direction of a sample's ray from the eye: unit length.
inline Vec3f camera_direction(const CameraView& view, const CameraPixel& pixel, const SamplePlace& place,
                              std::span<const float> table) {
  return unit_way(camera_way(view, pixel, place, table));
}

/// To a point of the square -1..1 one of the unit disc, as dense everywhere (P. Shirley, K. Chiu, "A low distortion map
/// between disk and square", 1997).
constexpr std::array<float, 2> disc_point(float x, float y) {
  const auto magnitude = [](float value) { return value < 0.0F ? -value : value; };
  constexpr float eighth = 0.785398163F;  // of a turn
  if (magnitude(x) > magnitude(y)) {
    const SineCosine turn = sine_cosine(y / x * eighth);
    return {x * turn.cosine, x * turn.sine};
  }
  if (y == 0.0F) return {0.0F, 0.0F};
  const SineCosine turn = sine_cosine(x / y * eighth);
  return {y * turn.sine, y * turn.cosine};
}

/// From the eye to a sample's point of the lens: points keep apart over a pixel's samples and over neighbours.
inline Vec3f lens_offset(const CameraView& view, const CameraPixel& pixel, std::uint32_t sample) {
  const StratifiedPair pair =
      stratified_pair(pixel.first_place | sample, hash_combine(view.seed, static_cast<std::uint32_t>(Dimension::lens)));
  const auto in_square = [](std::uint32_t at) {
    return static_cast<float>(static_cast<std::int32_t>(at >> 8U) - 0x80'0000) * 0x1p-23F;
  };
  const auto [x, y] = disc_point(in_square(pair.x), in_square(pair.y));
  return {view.lens_right[0] * x + view.lens_down[0] * y, view.lens_right[1] * x + view.lens_down[1] * y,
          view.lens_right[2] * x + view.lens_down[2] * y};
}

struct LensRay {
  Vec3f origin;     ///< on the lens
  Vec3f direction;  ///< unit length
};

constexpr bool has_lens(const CameraView& view) {
  return view.inverse_focus > 0.0F;
}

/// A sample's ray through a thin lens: from a point of the lens to where the ray through its middle meets the plane
/// that is sharp (R. Cook, T. Porter, L. Carpenter, "Distributed ray tracing", 1984).
inline LensRay lens_ray(const CameraView& view, const CameraPixel& pixel, std::uint32_t sample,
                        const SamplePlace& place, std::span<const float> table) {
  const Vec3f way = camera_way(view, pixel, place, table);
  const Vec3f offset = lens_offset(view, pixel, sample);
  return {{view.eye[0] + offset[0], view.eye[1] + offset[1], view.eye[2] + offset[2]},
          unit_way({way[0] - offset[0] * view.inverse_focus, way[1] - offset[1] * view.inverse_focus,
                    way[2] - offset[2] * view.inverse_focus})};
}

/// Of the random numbers on the sample's path.
constexpr std::uint32_t camera_key(const CameraPixel& pixel, std::uint32_t sample) {
  return hash_combine(pixel.key, sample);
}

}  // namespace torolux::protocol
