// SPDX-License-Identifier: MIT
// The hemi-cube: a pixel's number in, its weight and direction out. Numbering and table: firmware/protocol/stores.hpp.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "firmware/pe/shot.hpp"
#include "firmware/pe/vectors.hpp"
#include "firmware/protocol/stores.hpp"

namespace torolux::pe {

/// Where a pixel lies. On the top, row and column run along the frame's y and x; on a side, the row from the surface
/// up.
struct HemicubePixel {
  static constexpr std::uint32_t kTop = 4;
  std::uint32_t face;  ///< kTop, or a side: 0..3, those of +x, +y, -x, -y
  std::uint32_t row, column;
};

/// n: pixels across the top, even. number in 0..hemicube_pixels(n)-1.
inline HemicubePixel hemicube_pixel(std::uint32_t n, std::uint32_t number) {
  std::uint32_t face = HemicubePixel::kTop;
  if (number >= n * n) {
    number -= n * n;
    face = number / (n * (n / 2U));
    number -= face * n * (n / 2U);
  }
  const std::uint32_t row = number / n;
  return {face, row, number - row * n};
}

/// Index into the table of weights.
inline std::uint32_t weight_of(std::uint32_t n, const HemicubePixel& pixel) {
  const std::uint32_t half = n / 2U;
  const auto outwards = [half](std::uint32_t i) { return i >= half ? i - half : half - 1U - i; };
  if (pixel.face == HemicubePixel::kTop) return outwards(pixel.row) * half + outwards(pixel.column);
  return half * half + pixel.row * half + outwards(pixel.column);
}

/// Two random numbers in [0, 1): where in its pixel.
struct PixelPoint {
  float along = 0.5F, across = 0.5F;
};

/// A number in [0, 1] whose density goes from w0 to w1 as straight as a line; u uniform in [0, 1).
inline float on_slope(float u, float w0, float w1) {
  const float root = std::sqrt(w0 * w0 + (w1 * w1 - w0 * w0) * u);
  return root > 0.0F ? u * (w0 + w1) / (w0 + root) : 0.0F;
}

/// Likewise with a bend halfway, where the density is wm.
inline float on_two_slopes(float u, float w0, float wm, float w1) {
  const float before = w0 + wm;
  const float after = wm + w1;
  const float at = u * (before + after);
  if (at < before) return 0.5F * on_slope(at / before, w0, wm);
  return after > 0.0F ? 0.5F + 0.5F * on_slope((at - before) / after, wm, w1) : 1.0F;
}

/// A pixel on its face: its lower edges, and its length.
struct PixelBox {
  float along, across, size;
};

/// Where light goes through a pixel of the top. Its delta form factor per area is 1 / (pi (1 + x^2 + y^2)^2), taken as
/// linear between the pixel's edges and its middle: straight from edge to edge, what lies above the middle of a
/// hemi-cube of 4 pixels would get 0.7 % too little.
inline PixelPoint through_top(const PixelBox& box, PixelPoint at) {
  const auto weight = [](float x, float y) {
    const float root = 1.0F / (1.0F + (x * x + y * y));
    return root * root;
  };
  const float xm = box.along + 0.5F * box.size;
  const float x1 = box.along + box.size;
  const auto over_x = [&](float y) { return (weight(box.along, y) + weight(x1, y)) + 2.0F * weight(xm, y); };
  const float y = box.across + on_two_slopes(at.across, over_x(box.across), over_x(box.across + 0.5F * box.size),
                                             over_x(box.across + box.size)) *
                                   box.size;
  const float x = on_two_slopes(at.along, weight(box.along, y), weight(xm, y), weight(x1, y));
  return {box.along + x * box.size, y};
}

/// Likewise of a side: z / (pi (1 + y^2 + z^2)^2), z up from the surface. Its integral over z is known, so that z is
/// exact. Were light spread evenly over the pixels at a side's foot, too much of it would go along the surface, into
/// the nearest corner.
inline PixelPoint through_side(const PixelBox& box, PixelPoint at) {
  const float low = box.across * box.across;
  const float high = (box.across + box.size) * (box.across + box.size);
  const auto over_z = [low, high](float y) {
    const float from = 1.0F + y * y;
    return 1.0F / (from + low) - 1.0F / (from + high);
  };
  const float y = box.along + on_two_slopes(at.along, over_z(box.along), over_z(box.along + 0.5F * box.size),
                                            over_z(box.along + box.size)) *
                                  box.size;
  const float from = 1.0F + y * y;
  const float begin = 1.0F / (from + low);
  const float square = 1.0F / (begin + (1.0F / (from + high) - begin) * at.across) - from;
  return {y, square > low ? std::sqrt(square) : box.across};
}

/// Unit length. at: where in the pixel.
inline glm::vec3 pixel_direction(const Frame& frame, std::uint32_t n, const HemicubePixel& pixel, PixelPoint at) {
  const float size = 2.0F / static_cast<float>(n);
  const float column = static_cast<float>(pixel.column) * size - 1.0F;
  const float row = static_cast<float>(pixel.row) * size;
  if (pixel.face == HemicubePixel::kTop) {
    const PixelPoint top = through_top({column, row - 1.0F, size}, at);
    return glm::normalize((frame.x * top.along + frame.y * top.across) + frame.z);
  }
  const PixelPoint side = through_side({column, row, size}, at);
  const bool odd = (pixel.face & 1U) != 0;
  const glm::vec3 to_face = odd ? frame.y : frame.x;
  const glm::vec3 along = odd ? -frame.x : frame.y;
  const glm::vec3 on_face = to_face + along * side.along;
  return glm::normalize((pixel.face < 2U ? on_face : -on_face) + frame.z * side.across);
}

/// Turns a frame about its z by turn * 90 degrees - 45 degrees, turn in [0, 1): a hemi-cube looks the same after a
/// quarter.
inline Frame spun(const Frame& frame, float turn) {
  const SineCosine by = sine_cosine((turn - 0.5F) * 1.57079633F);
  return {frame.x * by.cosine + frame.y * by.sine, frame.y * by.cosine - frame.x * by.sine, frame.z};
}

}  // namespace torolux::pe
