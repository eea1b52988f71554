// SPDX-License-Identifier: MIT
// Exact integer arithmetic on flux: fractions of it are rounded once, and what is left over is never lost.
#pragma once

#include <cstdint>

#include "firmware/protocol/records.hpp"

namespace torolux::protocol {

/// Fraction of 2^32, rounded down: floor(amount * numerator / 2^32). amount in 0..2^62, numerator in 0..2^32.
constexpr std::int64_t scale_down(std::int64_t amount, std::uint64_t numerator) {
  if (numerator > 0xFFFF'FFFFU) return amount;
  const auto value = static_cast<std::uint64_t>(amount);
  const auto part = static_cast<std::uint32_t>(numerator);
  const std::uint64_t low = (value & 0xFFFF'FFFFU) * part;
  const std::uint64_t high = (value >> 32U) * part;
  return static_cast<std::int64_t>(high + (low >> 32U));
}

/// Divides an amount by weights that add up to 2^32, without losing any of it: the next part is what
/// scale_down(amount, weights up to this one) has risen by. rest: 0 before the first; keeps the part of a quantum that
/// is left over. amount in 0..2^62.
constexpr std::int64_t next_part(std::int64_t amount, std::uint32_t weight, std::uint32_t& rest) {
  const auto value = static_cast<std::uint64_t>(amount);
  const std::uint64_t low = (value & 0xFFFF'FFFFU) * weight + rest;
  rest = static_cast<std::uint32_t>(low);
  return static_cast<std::int64_t>((value >> 32U) * weight + (low >> 32U));
}

/// Reflectances and the like in flux arithmetic: 2^32 is one, rounded to nearest in `to_fraction`.
using Fraction = std::uint64_t;  ///< 0..2^32; a glossy lobe's to 2^33
inline constexpr Fraction kOne = Fraction{1} << 32U;

/// As scale_down, for fractions of up to 2. amount in 0..2^62.
constexpr std::int64_t scale_by(std::int64_t amount, Fraction fraction) {
  return fraction > kOne ? amount + scale_down(amount, fraction - kOne) : scale_down(amount, fraction);
}

constexpr Fraction to_fraction(double value) {
  if (!(value > 0.0)) return 0;
  if (value >= 1.0) return kOne;
  return static_cast<Fraction>(value * 4294967296.0 + 0.5);
}

}  // namespace torolux::protocol
