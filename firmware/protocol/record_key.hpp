// SPDX-License-Identifier: MIT
// Keys of the random numbers of a shot's records: the shot, a point and a pixel of its hemi-cube enter; a key leaves
// that no other record of the shot has, but by chance.
#pragma once

#include <cstdint>

#include "firmware/protocol/messages.hpp"
#include "firmware/protocol/random.hpp"

namespace torolux::protocol {

/// seed: of the run. patch: global number.
constexpr std::uint32_t shot_key(std::uint32_t seed, std::uint32_t patch, const Shoot& shoot) {
  const std::uint32_t side =
      hash_combine(hash_combine(seed, patch), shoot.side * 2U + static_cast<std::uint32_t>(shoot.kind));
  return hash_combine(side, shoot.number);
}

/// shot: key of the shot. Points and pixels are words of two kinds (a point is complemented): where they were of one,
/// point p with pixel q would have the key of q with p, and all with p = q the key 0.
constexpr std::uint32_t point_key(std::uint32_t shot, std::uint32_t point) {
  return hash_combine(shot, ~point);
}
constexpr std::uint32_t pixel_key(std::uint32_t shot, std::uint32_t pixel) {
  return hash_combine(shot, pixel);
}
constexpr std::uint32_t record_key(std::uint32_t point_key, std::uint32_t pixel_key) {
  return point_key ^ pixel_key;
}

}  // namespace torolux::protocol
