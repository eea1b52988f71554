// SPDX-License-Identifier: MIT
// Random numbers of the references: a seed and a stream in, uniform numbers out, the same on any computer.
#pragma once

#include <array>
#include <cstdint>

namespace torolux::references {

/// Finaliser of SplitMix64 (Steele, Lea & Flood 2014).
inline std::uint64_t mixed_bits(std::uint64_t value) {
  value += 0x9E3779B97F4A7C15U;
  value = (value ^ (value >> 30U)) * 0xBF58476D1CE4E5B9U;
  value = (value ^ (value >> 27U)) * 0x94D049BB133111EBU;
  return value ^ (value >> 31U);
}

/// PCG-XSH-RR 64/32 (O'Neill 2014, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for
/// Random Number Generation"). Not the product's hash, so that no pattern of that can hide in a comparison.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) : increment_((mixed_bits(stream) << 1U) | 1U) {
    next();
    state_ += mixed_bits(seed ^ mixed_bits(stream + 1));
    next();
  }

  /// In [0, 1), multiples of 2^-32.
  double uniform() { return next() * 0x1p-32; }

 private:
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

/// Samples of one integral, say a pixel: pairs of numbers that are well spread over all samples of the stream for the
/// first few dimensions, and independent ones beyond. Any number of samples; powers of two are best spread.
///
/// Each pair is the (0, 2)-sequence of Sobol', shuffled and Owen-scrambled by hashing (Burley 2020, "Practical
/// hash-based Owen scrambling"; permutation by N. Vegdahl).
class Samples {
 public:
  Samples(std::uint64_t seed, std::uint64_t stream)
      : random_(seed, stream), key_(mixed_bits(seed + mixed_bits(stream))) {}

  void begin(std::uint32_t sample) { sample_ = sample; }

  /// Two numbers in [0, 1). dimension: which pair of the sample; each is asked for once.
  std::array<double, 2> pair(unsigned dimension) {
    if (dimension >= kSpread) {
      const double first = random_.uniform();
      return {first, random_.uniform()};
    }
    const std::uint64_t key = mixed_bits(key_ + dimension);
    const auto low = static_cast<std::uint32_t>(key);
    const auto high = static_cast<std::uint32_t>(key >> 32U);
    const std::uint32_t index = scrambled(sample_, low ^ high);
    std::uint32_t second = 0;
    std::uint32_t direction = 0x8000'0000U;
    for (std::uint32_t rest = index; rest != 0; rest >>= 1U, direction ^= direction >> 1U) {
      if ((rest & 1U) != 0) second ^= direction;
    }
    return {scrambled(reversed(index), low) * 0x1p-32, scrambled(second, high) * 0x1p-32};
  }
  /// Independent of all else.
  double uniform() { return random_.uniform(); }

 private:
  static constexpr unsigned kSpread = 12;

  static std::uint32_t reversed(std::uint32_t bits) {
    bits = (bits << 16U) | (bits >> 16U);
    bits = ((bits & 0x00FF'00FFU) << 8U) | ((bits & 0xFF00'FF00U) >> 8U);
    bits = ((bits & 0x0F0F'0F0FU) << 4U) | ((bits & 0xF0F0'F0F0U) >> 4U);
    bits = ((bits & 0x3333'3333U) << 2U) | ((bits & 0xCCCC'CCCCU) >> 2U);
    return ((bits & 0x5555'5555U) << 1U) | ((bits & 0xAAAA'AAAAU) >> 1U);
  }
  static std::uint32_t scrambled(std::uint32_t value, std::uint32_t key) {
    std::uint32_t bits = reversed(value);
    bits ^= bits * 0x3D20ADEAU;
    bits += key;
    bits *= (key >> 16U) | 1U;
    bits ^= bits * 0x05526C56U;
    bits ^= bits * 0x53A22864U;
    return reversed(bits);
  }

  Random random_;
  std::uint64_t key_;
  std::uint32_t sample_ = 0;
};

}  // namespace torolux::references
