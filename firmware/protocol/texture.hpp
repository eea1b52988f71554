// SPDX-License-Identifier: MIT
// Textures as the machine holds them, and how they are looked up: host and PEs share it, so that pictures and radiosity
// have the same reflectances.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/protocol/records.hpp"

namespace torolux::protocol {

/// R, G, B of ten bits each, R lowest: square roots of the linear share, in units of 1/1023, so that dark colours keep
/// their shades.
using Texel = std::uint32_t;
inline constexpr float kTexelUnit = 1.0F / 1023.0F;

inline constexpr std::uint32_t kNoTexture = 0xFFFF'FFFFU;
inline constexpr std::uint32_t kMostTextureEdge = 16384;

struct Texture {
  std::uint32_t width, height;  ///< 1..kMostTextureEdge
  std::uint32_t first_texel;    ///< index; width * height of them, row by row from the lowest v
};
static_assert(sizeof(Texture) == 12);

/// u rightwards, v upwards; the texture repeats with period 1.
struct TexturePoint {
  float u, v;
};
/// Of a polygon's corners: so that an index of a texel is an integer that float holds.
inline constexpr float kMostTexturePoint = 1024.0F * 1024.0F;

/// 0..1.
constexpr Vec3f texel_colour(Texel texel) {
  const auto channel = [texel](std::uint32_t shift) {
    const float root = static_cast<float>((texel >> shift) & 1023U) * kTexelUnit;
    return root * root;
  };
  return {channel(0), channel(10), channel(20)};
}

/// Two neighbours along an axis of `size` texels, and the second one's share.
struct TexelPair {
  std::uint32_t first, second;
  float share;
};
/// x: texture coordinate, |x| <= 2 * kMostTexturePoint.
constexpr TexelPair texel_pair(float x, std::uint32_t size) {
  auto whole = static_cast<float>(static_cast<std::int32_t>(x));
  if (whole > x) whole -= 1.0F;
  const float at = (x - whole) * static_cast<float>(size) + 0.5F;  // centres of texels lie at whole numbers
  const auto above = static_cast<std::uint32_t>(at);               // of two neighbours the one beyond: 0..size
  return {above == 0 ? size - 1U : above - 1U, above >= size ? 0U : above, at - static_cast<float>(above)};
}

/// Bilinear, in linear light. texels: the texture's own.
constexpr Vec3f texture_colour(const Texel* texels, std::uint32_t width, std::uint32_t height, TexturePoint at) {
  const TexelPair across = texel_pair(at.u, width);
  const TexelPair up = texel_pair(at.v, height);
  const Vec3f a = texel_colour(texels[up.first * width + across.first]);
  const Vec3f b = texel_colour(texels[up.first * width + across.second]);
  const Vec3f c = texel_colour(texels[up.second * width + across.first]);
  const Vec3f d = texel_colour(texels[up.second * width + across.second]);
  Vec3f colour{};
  for (std::size_t i = 0; i < 3; ++i) {
    const float low = a[i] + (b[i] - a[i]) * across.share;
    const float high = c[i] + (d[i] - c[i]) * across.share;
    colour[i] = low + (high - low) * up.share;
  }
  return colour;
}

}  // namespace torolux::protocol
