// SPDX-License-Identifier: MIT
// Random numbers that depend on what they are for and never on time or place: a hash of a chain of words.
#pragma once

#include <cstdint>

namespace torolux::protocol {

/// Mixes one more word into a key. Finaliser "lowbias32" (C. Wellons, hash-prospector) over an odd-multiplied sum.
constexpr std::uint32_t hash_combine(std::uint32_t key, std::uint32_t word) {
  std::uint32_t x = key * 0x9E37'79B1U + word + 0x7F4A'7C15U;
  x ^= x >> 16U;
  x *= 0x21F0'AAADU;
  x ^= x >> 15U;
  x *= 0x735A'2D97U;
  x ^= x >> 15U;
  return x;
}

/// Uniform in [0, 1): the upper 24 bits, exact in a float.
constexpr float uniform_float(std::uint32_t hash) {
  return static_cast<float>(hash >> 8U) * 0x1p-24F;
}

/// What a random number is for: the last word of every chain.
enum class Dimension : std::uint32_t {
  spin = 1,
  pixel_x,
  pixel_y,
  fresnel,
  branch,
  emitter,
  place,
  lobe,
  lobe_height,
  lobe_turn,
  lens,
};

constexpr float uniform(std::uint32_t key, Dimension dimension) {
  return uniform_float(hash_combine(key, static_cast<std::uint32_t>(dimension)));
}

}  // namespace torolux::protocol
