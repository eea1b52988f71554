// SPDX-License-Identifier: MIT
// Random numbers of the references: a seed and a stream in, independent uniform numbers out, the same on any computer.
#pragma once

#include <cstdint>

namespace torolux::references {

/// PCG-XSH-RR 64/32 (O'Neill 2014, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for
/// Random Number Generation"). Not the product's hash, so that no pattern of that can hide in a comparison.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) : increment_((mixed(stream) << 1U) | 1U) {
    next();
    state_ += mixed(seed ^ mixed(stream + 1));
    next();
  }

  /// In [0, 1), multiples of 2^-32.
  double uniform() { return next() * 0x1p-32; }

 private:
  /// Finaliser of SplitMix64 (Steele, Lea & Flood 2014).
  static std::uint64_t mixed(std::uint64_t value) {
    value += 0x9E3779B97F4A7C15U;
    value = (value ^ (value >> 30U)) * 0xBF58476D1CE4E5B9U;
    value = (value ^ (value >> 27U)) * 0x94D049BB133111EBU;
    return value ^ (value >> 31U);
  }
  std::uint32_t next() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005U + increment_;
    const auto shifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
    const auto turn = static_cast<std::uint32_t>(old >> 59U);
    return (shifted >> turn) | (shifted << ((32U - turn) & 31U));
  }

  std::uint64_t state_ = 0;
  std::uint64_t increment_;
};

}  // namespace torolux::references
