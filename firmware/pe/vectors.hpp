// SPDX-License-Identifier: MIT
// Small arithmetic that all handlers share: the protocol's arrays as GLM vectors, and floats ordered as integers.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "firmware/protocol/records.hpp"
#include "firmware/protocol/sine_cosine.hpp"

namespace torolux::pe {

inline glm::vec3 to_vector(const protocol::Vec3f& v) {
  return {v[0], v[1], v[2]};
}
inline protocol::Vec3f to_array(const glm::vec3& v) {
  return {v.x, v.y, v.z};
}

inline void add_flux(protocol::Flux& sum, const protocol::Flux& flux) {
  for (std::size_t c = 0; c < 3; ++c) sum[c] += flux[c];
}

inline std::int32_t bits(float value) {
  return std::bit_cast<std::int32_t>(value);
}

/// An integer that is ordered as the floats are (-0 right below +0): comparing costs a fraction of a float comparison.
inline std::int32_t ordered(float value) {
  const std::int32_t b = bits(value);
  return b ^ static_cast<std::int32_t>(static_cast<std::uint32_t>(b >> 31) >> 1U);
}

using protocol::sine_cosine;
using protocol::SineCosine;

/// a, b, c all above zero, or all below.
inline bool strictly_one_side(std::int32_t a, std::int32_t b, std::int32_t c) {
  if (a > 0) return b > 0 && c > 0;
  constexpr std::uint32_t minus_zero = 0x8000'0000U;
  return static_cast<std::uint32_t>(a) > minus_zero && static_cast<std::uint32_t>(b) > minus_zero &&
         static_cast<std::uint32_t>(c) > minus_zero;
}

}  // namespace torolux::pe
