// SPDX-License-Identifier: MIT
// Single-precision operations as RISC-V defines them, in every rounding mode and with their flags: bits in, bits out.
// Exact in double precision to the odd neighbour, then rounded once: Boldo and Melquiond, "Emulation of a FMA and
// correctly rounded sums: proved algorithms using rounding to odd", 2008. The host must round to nearest meanwhile.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace torolux::translated::soft {

enum class Rounding : std::uint8_t { nearest_even, to_zero, down, up, nearest_away };

/// Bits of fflags.
enum Flags : std::uint32_t { kInexact = 1, kUnderflow = 2, kOverflow = 4, kDivideByZero = 8, kInvalid = 16 };

inline constexpr std::uint32_t kCanonicalNan = 0x7FC0'0000U;
inline constexpr std::uint32_t kSign = 0x8000'0000U;
inline constexpr std::uint32_t kInfinity = 0x7F80'0000U;

constexpr bool is_nan(std::uint32_t a) {
  return (a & ~kSign) > kInfinity;
}
constexpr bool is_signalling(std::uint32_t a) {
  return is_nan(a) && (a & 0x0040'0000U) == 0;
}
constexpr bool is_infinite(std::uint32_t a) {
  return (a & ~kSign) == kInfinity;
}
constexpr bool is_zero(std::uint32_t a) {
  return (a & ~kSign) == 0;
}
inline double wide(std::uint32_t a) {
  return static_cast<double>(std::bit_cast<float>(a));
}

/// Whether a magnitude of `kept` with `rest` of 2^shift behind it is rounded up.
constexpr bool rounds_up(std::uint64_t kept, std::uint64_t rest, unsigned shift, bool negative, Rounding mode) {
  const std::uint64_t half = std::uint64_t{1} << (shift - 1U);
  switch (mode) {
    case Rounding::nearest_even:
      return rest > half || (rest == half && (kept & 1U) != 0);
    case Rounding::to_zero:
      return false;
    case Rounding::down:
      return negative && rest != 0;
    case Rounding::up:
      return !negative && rest != 0;
    case Rounding::nearest_away:
      return rest >= half;
  }
  return false;
}

/// The magnitude that stands for one too large.
constexpr std::uint32_t overflowed(bool negative, Rounding mode) {
  const bool to_largest =
      mode == Rounding::to_zero || (mode == Rounding::down && !negative) || (mode == Rounding::up && negative);
  return to_largest ? kInfinity - 1 : kInfinity;
}

/// value: finite and not 0, exact or rounded to odd.
inline std::uint32_t round_to_single(double value, Rounding mode, std::uint32_t& flags) {
  constexpr unsigned kDropped = 52 - 23;
  constexpr unsigned kMostShift = 62;
  constexpr int kSmallestExponent = -126;
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const bool negative = (bits >> 63U) != 0;
  const int exponent = static_cast<int>((bits >> 52U) & 0x7FFU) - 1023;
  const std::uint64_t significand = (bits & 0xF'FFFF'FFFF'FFFFU) | 0x10'0000'0000'0000U;
  const unsigned below = exponent < kSmallestExponent ? static_cast<unsigned>(kSmallestExponent - exponent) : 0U;
  const unsigned shift = below > kMostShift - kDropped ? kMostShift : kDropped + below;
  std::uint64_t kept = significand >> shift;
  const std::uint64_t rest = significand & ((std::uint64_t{1} << shift) - 1U);
  if (rounds_up(kept, rest, shift, negative, mode)) ++kept;
  if (rest != 0) flags |= kInexact;
  if (below != 0 && rest != 0) {
    // Tiny after rounding: as if exponents went on below.
    const std::uint64_t unbounded = significand >> kDropped;
    const std::uint64_t unbounded_rest = significand & ((std::uint64_t{1} << kDropped) - 1U);
    const bool carries = unbounded == 0xFF'FFFFU && rounds_up(unbounded, unbounded_rest, kDropped, negative, mode);
    if (below > 1 || !carries) flags |= kUnderflow;
  }
  const std::uint32_t sign = negative ? kSign : 0;
  if (below != 0) return sign | static_cast<std::uint32_t>(kept);
  if (exponent > 127) kept = std::uint64_t{1} << 32U;  // anything beyond the range
  const std::uint64_t magnitude = (static_cast<std::uint64_t>(exponent > 127 ? 0 : exponent + 126) << 23U) + kept;
  if (magnitude >= kInfinity) {
    flags |= kOverflow | kInexact;
    return sign | overflowed(negative, mode);
  }
  return sign | static_cast<std::uint32_t>(magnitude);
}

/// The odd neighbour of an inexact result; away: the exact magnitude is larger than the result's.
inline double to_odd(double result, bool away) {
  auto bits = std::bit_cast<std::uint64_t>(result);
  if ((bits & 1U) == 0) bits = away ? bits + 1 : bits - 1;
  return std::bit_cast<double>(bits);
}

inline std::uint32_t nan_of(bool invalid, std::uint32_t& flags) {
  if (invalid) flags |= kInvalid;
  return kCanonicalNan;
}

/// a + b for finite a, b, exact operands.
inline std::uint32_t add_wide(double a, double b, Rounding mode, std::uint32_t& flags) {
  const double sum = a + b;
  const double part = sum - a;
  const double error = (a - (sum - part)) + (b - part);  // Knuth's TwoSum
  if (sum == 0) {
    if (std::signbit(a) == std::signbit(b)) return std::signbit(a) ? kSign : 0;
    return mode == Rounding::down ? kSign : 0;
  }
  const double exact = error == 0 ? sum : to_odd(sum, (error > 0) == (sum > 0));
  return round_to_single(exact, mode, flags);
}

inline std::uint32_t add(std::uint32_t a, std::uint32_t b, Rounding mode, std::uint32_t& flags) {
  if (is_nan(a) || is_nan(b)) return nan_of(is_signalling(a) || is_signalling(b), flags);
  if (is_infinite(a)) return is_infinite(b) && a != b ? nan_of(true, flags) : a;
  if (is_infinite(b)) return b;
  return add_wide(wide(a), wide(b), mode, flags);
}
inline std::uint32_t sub(std::uint32_t a, std::uint32_t b, Rounding mode, std::uint32_t& flags) {
  return add(a, is_nan(b) ? b : b ^ kSign, mode, flags);
}

inline std::uint32_t mul(std::uint32_t a, std::uint32_t b, Rounding mode, std::uint32_t& flags) {
  if (is_nan(a) || is_nan(b)) return nan_of(is_signalling(a) || is_signalling(b), flags);
  const std::uint32_t sign = (a ^ b) & kSign;
  if (is_infinite(a) || is_infinite(b)) return is_zero(a) || is_zero(b) ? nan_of(true, flags) : sign | kInfinity;
  if (is_zero(a) || is_zero(b)) return sign;
  return round_to_single(wide(a) * wide(b), mode, flags);
}

inline std::uint32_t div(std::uint32_t a, std::uint32_t b, Rounding mode, std::uint32_t& flags) {
  if (is_nan(a) || is_nan(b)) return nan_of(is_signalling(a) || is_signalling(b), flags);
  const std::uint32_t sign = (a ^ b) & kSign;
  if (is_infinite(a)) return is_infinite(b) ? nan_of(true, flags) : sign | kInfinity;
  if (is_infinite(b)) return sign;
  if (is_zero(b)) {
    if (is_zero(a)) return nan_of(true, flags);
    flags |= kDivideByZero;
    return sign | kInfinity;
  }
  if (is_zero(a)) return sign;
  const double quotient = wide(a) / wide(b);
  const double rest = std::fma(-quotient, wide(b), wide(a));
  const double exact = rest == 0 ? quotient : to_odd(quotient, ((rest > 0) == (wide(b) > 0)) == (quotient > 0));
  return round_to_single(exact, mode, flags);
}

inline std::uint32_t sqrt(std::uint32_t a, Rounding mode, std::uint32_t& flags) {
  if (is_nan(a)) return nan_of(is_signalling(a), flags);
  if (is_zero(a)) return a;
  if ((a & kSign) != 0) return nan_of(true, flags);
  if (is_infinite(a)) return a;
  const double root = std::sqrt(wide(a));
  const double rest = std::fma(-root, root, wide(a));
  return round_to_single(rest == 0 ? root : to_odd(root, rest > 0), mode, flags);
}

/// a * b + c, rounded once.
inline std::uint32_t fused(std::uint32_t a, std::uint32_t b, std::uint32_t c, Rounding mode, std::uint32_t& flags) {
  const bool no_product = (is_infinite(a) && is_zero(b)) || (is_zero(a) && is_infinite(b));
  if (is_nan(a) || is_nan(b) || is_nan(c) || no_product) {
    return nan_of(no_product || is_signalling(a) || is_signalling(b) || is_signalling(c), flags);
  }
  const std::uint32_t sign = (a ^ b) & kSign;
  if (is_infinite(a) || is_infinite(b)) {
    return is_infinite(c) && (c & kSign) != sign ? nan_of(true, flags) : sign | kInfinity;
  }
  if (is_infinite(c)) return c;
  return add_wide(wide(a) * wide(b), wide(c), mode, flags);
}

/// minimumNumber and maximumNumber of IEEE 754-2019; -0 is less than +0.
inline std::uint32_t min_or_max(std::uint32_t a, std::uint32_t b, bool want_max, std::uint32_t& flags) {
  if (is_signalling(a) || is_signalling(b)) flags |= kInvalid;
  if (is_nan(a)) return is_nan(b) ? kCanonicalNan : b;
  if (is_nan(b)) return a;
  const bool a_is_less =
      is_zero(a) && is_zero(b) ? (a & kSign) != 0 : std::bit_cast<float>(a) < std::bit_cast<float>(b);
  return a_is_less != want_max ? a : b;
}

inline std::uint32_t equal(std::uint32_t a, std::uint32_t b, std::uint32_t& flags) {
  if (is_signalling(a) || is_signalling(b)) flags |= kInvalid;
  return std::bit_cast<float>(a) == std::bit_cast<float>(b) ? 1 : 0;
}
inline std::uint32_t less(std::uint32_t a, std::uint32_t b, bool or_equal, std::uint32_t& flags) {
  if (is_nan(a) || is_nan(b)) {
    flags |= kInvalid;
    return 0;
  }
  const float left = std::bit_cast<float>(a);
  const float right = std::bit_cast<float>(b);
  return left < right || (or_equal && left == right) ? 1 : 0;
}

/// To an integer between lowest and highest; NaN counts as too large.
inline std::int64_t to_integer(std::uint32_t a, std::int64_t lowest, std::int64_t highest, Rounding mode,
                               std::uint32_t& flags) {
  constexpr unsigned kFraction = 20;  // bits below the point that are kept, the last one standing for all further ones
  constexpr double kBeyond = 8589934592.0;  // 2^33
  const double value = is_nan(a) ? 0 : wide(a);
  if (is_nan(a) || value >= kBeyond || value <= -kBeyond) {
    flags |= kInvalid;
    return is_nan(a) || value > 0 ? highest : lowest;
  }
  const bool negative = value < 0;
  const double scaled = std::fabs(value) * static_cast<double>(1U << kFraction);
  const double whole = std::floor(scaled);
  auto magnitude = static_cast<std::uint64_t>(whole);
  if (whole != scaled) magnitude |= 1U;
  const std::uint64_t rest = magnitude & ((1U << kFraction) - 1U);
  std::uint64_t kept = magnitude >> kFraction;
  if (rounds_up(kept, rest, kFraction, negative, mode)) ++kept;
  const std::int64_t result = negative ? -static_cast<std::int64_t>(kept) : static_cast<std::int64_t>(kept);
  if (result < lowest || result > highest) {
    flags |= kInvalid;
    return result < lowest ? lowest : highest;
  }
  if (rest != 0) flags |= kInexact;
  return result;
}
inline std::uint32_t to_signed(std::uint32_t a, Rounding mode, std::uint32_t& flags) {
  using Limits = std::numeric_limits<std::int32_t>;
  return static_cast<std::uint32_t>(to_integer(a, Limits::min(), Limits::max(), mode, flags));
}
inline std::uint32_t to_unsigned(std::uint32_t a, Rounding mode, std::uint32_t& flags) {
  return static_cast<std::uint32_t>(to_integer(a, 0, std::numeric_limits<std::uint32_t>::max(), mode, flags));
}
inline std::uint32_t from_integer(double value, Rounding mode, std::uint32_t& flags) {
  return value == 0 ? 0 : round_to_single(value, mode, flags);
}
inline std::uint32_t from_signed(std::uint32_t a, Rounding mode, std::uint32_t& flags) {
  return from_integer(static_cast<double>(static_cast<std::int32_t>(a)), mode, flags);
}
inline std::uint32_t from_unsigned(std::uint32_t a, Rounding mode, std::uint32_t& flags) {
  return from_integer(static_cast<double>(a), mode, flags);
}

/// The mask of fclass.s.
constexpr std::uint32_t classify(std::uint32_t a) {
  if (is_nan(a)) return is_signalling(a) ? 1U << 8U : 1U << 9U;
  const bool negative = (a & kSign) != 0;
  if (is_infinite(a)) return negative ? 1U << 0U : 1U << 7U;
  if (is_zero(a)) return negative ? 1U << 3U : 1U << 4U;
  const bool subnormal = (a & kInfinity) == 0;
  if (subnormal) return negative ? 1U << 2U : 1U << 5U;
  return negative ? 1U << 1U : 1U << 6U;
}

}  // namespace torolux::translated::soft
