// SPDX-License-Identifier: MIT
// The hemi-cube: a pixel's number in, its weight and direction out. Numbering and table: firmware/protocol/stores.hpp.
#pragma once

#include <cstdint>
#include <span>

#include "firmware/pe/shot.hpp"
#include "firmware/pe/vectors.hpp"
#include "firmware/protocol/stores.hpp"

namespace torolux::pe {

/// One pixel of a hemi-cube of n pixels across the top, seen along the axes of its frame.
struct HemicubePixel {
  std::uint32_t weight;  ///< index into the table of weights
  float x, y, z;         ///< a point of the pixel, on the cube of half-width 1
};

/// Where in its pixel, from edge to edge; 0: in the middle.
struct PixelPoint {
  float along = 0.0F, across = 0.0F;  ///< -1..1
};

/// n even, number in 0..hemicube_pixels(n)-1.
inline HemicubePixel hemicube_pixel(std::uint32_t n, std::uint32_t number, PixelPoint at = {}) {
  const std::uint32_t half = n / 2U;
  const float unit = 1.0F / static_cast<float>(n);
  const auto outwards = [half](std::uint32_t i) { return i >= half ? i - half : half - 1U - i; };
  const auto place = [n, unit](std::uint32_t i, float offset) {
    const auto middle = static_cast<float>(static_cast<std::int32_t>(2U * i + 1U) - static_cast<std::int32_t>(n));
    return (middle + offset) * unit;
  };
  if (number < n * n) {
    const std::uint32_t row = number / n;
    const std::uint32_t column = number - row * n;
    return {outwards(row) * half + outwards(column), place(column, at.along), place(row, at.across), 1.0F};
  }
  number -= n * n;
  const std::uint32_t side = number / (n * half);
  number -= side * n * half;
  const std::uint32_t row = number / n;
  const std::uint32_t column = number - row * n;
  const std::uint32_t weight = half * half + row * half + outwards(column);
  const float along = place(column, at.along);
  const float up = (static_cast<float>(2U * row + 1U) + at.across) * unit;
  switch (side) {
    case 0:
      return {weight, 1.0F, along, up};
    case 1:
      return {weight, -along, 1.0F, up};
    case 2:
      return {weight, -1.0F, -along, up};
    default:
      return {weight, along, -1.0F, up};
  }
}

inline glm::vec3 pixel_direction(const Frame& frame, const HemicubePixel& pixel) {
  return glm::normalize((frame.x * pixel.x + frame.y * pixel.y) + frame.z * pixel.z);
}

/// Turns a frame about its z by turn * 90 degrees - 45 degrees, turn in [0, 1): a hemi-cube looks the same after a
/// quarter. Sine and cosine by their series, so that every machine computes the same bits; errors below 3e-8.
inline Frame spun(const Frame& frame, float turn) {
  const float a = (turn - 0.5F) * 1.57079633F;
  const float q = a * a;
  const float sine =
      a * (1.0F - q * (1.0F / 6.0F - q * (1.0F / 120.0F - q * (1.0F / 5040.0F - q * (1.0F / 362880.0F)))));
  const float cosine = 1.0F - q * (0.5F - q * (1.0F / 24.0F - q * (1.0F / 720.0F - q * (1.0F / 40320.0F))));
  return {frame.x * cosine + frame.y * sine, frame.y * cosine - frame.x * sine, frame.z};
}

/// Weights of a patch's corners at point `point` of k * k: the centroids of the small triangles of a uniform grid,
/// those that stand upright first.
struct PatchPoint {
  float a, b;  ///< of corners 1 and 2; corner 0 has the rest
};
inline PatchPoint patch_point(std::uint32_t k, std::uint32_t point) {
  const std::uint32_t upright = k * (k + 1U) / 2U;
  const bool inverted = point >= upright;
  if (inverted) point -= upright;
  std::uint32_t row = 0;
  for (std::uint32_t length = inverted ? k - 1U : k; point >= length; --length) {
    point -= length;
    ++row;
  }
  const std::uint32_t thirds = inverted ? 2U : 1U;
  const float unit = 1.0F / static_cast<float>(3U * k);
  return {static_cast<float>(3U * point + thirds) * unit, static_cast<float>(3U * row + thirds) * unit};
}

}  // namespace torolux::pe
