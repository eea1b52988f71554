// SPDX-License-Identifier: MIT
// The hemi-cube: a pixel's number in, its entry in the table and its direction out. Numbering and table:
// firmware/protocol/stores.hpp.
#pragma once

#include <cmath>
#include <cstdint>

#include "firmware/pe/shot.hpp"
#include "firmware/pe/vectors.hpp"
#include "firmware/protocol/stores.hpp"

namespace torolux::pe {

/// What is computed once of a hemi-cube of n pixels across the top, n even.
struct HemicubeGrid {
  HemicubeGrid() = default;
  explicit HemicubeGrid(std::uint32_t pixels)
      : n(pixels), inverse(0xFFFF'FFFFU / pixels + 1U), pixel_size(2.0F / static_cast<float>(pixels)) {}
  std::uint32_t n = 0;
  std::uint32_t inverse = 0;  ///< 2^32 / n, rounded up: quotients of pixels' numbers by one multiplication, exactly
  float pixel_size = 0.0F;    ///< the top's edge is 2 long
};
static_assert(std::uint64_t{protocol::hemicube_pixels(protocol::kMostHemicubeSize)} * protocol::kMostHemicubeSize <
              (1ULL << 32U));

/// Where a pixel lies. On the top, row and column run along the frame's y and x; on a side, the row from the surface
/// up.
struct HemicubePixel {
  static constexpr std::uint32_t kTop = 4;
  std::uint32_t face;  ///< kTop, or a side: 0..3, those of +x, +y, -x, -y
  std::uint32_t row, column;
};

/// number in 0..hemicube_pixels(n)-1.
inline HemicubePixel hemicube_pixel(const HemicubeGrid& grid, std::uint32_t number) {
  const auto by_n = [&](std::uint32_t x) {
    return static_cast<std::uint32_t>((std::uint64_t{x} * grid.inverse) >> 32U);
  };
  const std::uint32_t top = grid.n * grid.n;
  if (number < top) {
    const std::uint32_t row = by_n(number);
    return {HemicubePixel::kTop, row, number - row * grid.n};
  }
  const std::uint32_t row = by_n(number - top);  // of n / 2 on each side
  const std::uint32_t face = by_n(2U * row);
  return {face, row - face * (grid.n / 2U), number - top - row * grid.n};
}

/// How many pixels of a row or column lie between pixel i and its middle; beyond it or before it.
inline std::uint32_t outwards(std::uint32_t half, std::uint32_t i) {
  return i >= half ? i - half : half - 1U - i;
}

/// Index into the table (protocol::HemicubeEntry).
inline std::uint32_t entry_of(std::uint32_t n, const HemicubePixel& pixel) {
  const std::uint32_t half = n / 2U;
  const std::uint32_t row = pixel.face == HemicubePixel::kTop ? outwards(half, pixel.row) : half + pixel.row;
  return row * half + outwards(half, pixel.column);
}

/// Two random numbers in [0, 1): where in its pixel.
struct PixelPoint {
  float along = 0.5F, across = 0.5F;
};

/// Where light goes through a pixel by one random number: firmware/protocol/hemicube_bends.hpp.
inline float bent(float u, float p, float q) {
  return u + u * (1.0F - u) * (p + q * u);
}

/// Through a pixel of the top, of unit length in the frame. Its delta form factor per area is
/// 1 / (pi (1 + x^2 + y^2)^2): spread evenly, too little would go through the pixel's inner part.
inline glm::vec3 through_top(const HemicubeGrid& grid, const HemicubePixel& pixel, const protocol::HemicubeEntry& entry,
                             PixelPoint at) {
  const std::uint32_t half = grid.n / 2U;
  const float v = bent(at.across, entry.first.p, entry.first.q);
  const float u = bent(at.along, entry.second.p + entry.second_by.p * v, entry.second.q + entry.second_by.q * v);
  const float x = (static_cast<float>(outwards(half, pixel.column)) + u) * grid.pixel_size;
  const float y = (static_cast<float>(outwards(half, pixel.row)) + v) * grid.pixel_size;
  const float r = 1.0F / std::sqrt((x * x + y * y) + 1.0F);
  return {pixel.column >= half ? x * r : -(x * r), pixel.row >= half ? y * r : -(y * r), r};
}

/// Likewise of a side: z / (pi (1 + y^2 + z^2)^2), z up from the surface. Were light spread evenly over the pixels at a
/// side's foot, too much of it would go along the surface, into the nearest corner. Its integral over z,
/// -1 / 2 (1 + y^2 + z^2), is the squared length that the direction has at the face: so that this one is even between
/// the pixel's lower and upper edge, and no division is needed to make the direction's length one.
inline glm::vec3 through_side(const HemicubeGrid& grid, const HemicubePixel& pixel,
                              const protocol::HemicubeEntry& entry, PixelPoint at) {
  const std::uint32_t half = grid.n / 2U;
  const float u = bent(at.along, entry.first.p, entry.first.q);
  const float y = (static_cast<float>(outwards(half, pixel.column)) + u) * grid.pixel_size;
  const float foot = static_cast<float>(pixel.row) * grid.pixel_size;
  const float head = foot + grid.pixel_size;
  const float low = foot * foot;
  const float from = 1.0F + y * y;
  const float to_low = from + low;
  const float to_high = from + head * head;
  const float inverse = 1.0F / (to_low * to_high);
  const float begin = to_high * inverse;                          // 1 / to_low
  const float part = ((to_high - to_low) * inverse) * at.across;  // of begin - end
  const float r = std::sqrt(begin - part);
  const float z = std::sqrt(low * begin + from * part);  // 1 - from * r^2, without its rounding
  const float yr = pixel.column >= half ? y * r : -(y * r);
  if (pixel.face == 0) return {r, yr, z};
  if (pixel.face == 1) return {-yr, r, z};
  if (pixel.face == 2) return {-r, -yr, z};
  return {yr, -r, z};
}

/// Unit length. entry: the pixel's; at: where in the pixel.
inline glm::vec3 pixel_direction(const Frame& frame, const HemicubeGrid& grid, const HemicubePixel& pixel,
                                 const protocol::HemicubeEntry& entry, PixelPoint at) {
  const glm::vec3 d =
      pixel.face == HemicubePixel::kTop ? through_top(grid, pixel, entry, at) : through_side(grid, pixel, entry, at);
  return (frame.x * d.x + frame.y * d.y) + frame.z * d.z;
}

/// Turns a frame about its z by turn * 90 degrees - 45 degrees, turn in [0, 1): a hemi-cube looks the same after a
/// quarter.
inline Frame spun(const Frame& frame, float turn) {
  const SineCosine by = sine_cosine((turn - 0.5F) * 1.57079633F);
  return {frame.x * by.cosine + frame.y * by.sine, frame.y * by.cosine - frame.x * by.sine, frame.z};
}

}  // namespace torolux::pe
