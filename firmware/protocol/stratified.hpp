// SPDX-License-Identifier: MIT
// Random numbers that keep apart, of a pixel's samples or of a shot's points: pairs of a (0,2)-sequence, scrambled by a
// key. Of any 2^m of them that begin at a multiple of 2^m, one lies in each of the 2^m cells of every grid of equal
// boxes over the unit square. Triples have a third number, of Sobol's sequence (1967): one in each of 2^m equal parts,
// and with either of the others no more than two in any cell.
#pragma once

#include <cstdint>

#include "firmware/protocol/random.hpp"

namespace torolux::protocol {

/// Two numbers in units of 2^-32.
struct StratifiedPair {
  std::uint32_t x, y;
};

/// Likewise.
struct StratifiedTriple {
  std::uint32_t x, y, z;
};

constexpr std::uint32_t reversed_bits(std::uint32_t x) {
  x = (x >> 16U) | (x << 16U);
  x = ((x >> 8U) & 0x00FF'00FFU) | ((x & 0x00FF'00FFU) << 8U);
  x = ((x >> 4U) & 0x0F0F'0F0FU) | ((x & 0x0F0F'0F0FU) << 4U);
  x = ((x >> 2U) & 0x3333'3333U) | ((x & 0x3333'3333U) << 2U);
  return ((x >> 1U) & 0x5555'5555U) | ((x & 0x5555'5555U) << 1U);
}

/// Owen's scrambling of a number whose bits are reversed: a bit is flipped by chance, as all lower ones and the key
/// say. Burley 2020, Practical Hash-based Owen Scrambling; with N. Vegdahl's constants (Building a Better LK Hash,
/// 2021).
constexpr std::uint32_t scrambled(std::uint32_t reversed, std::uint32_t key) {
  std::uint32_t x = reversed;
  x ^= x * 0x3D20'ADEAU;
  x += key;
  x *= (key >> 16U) | 1U;
  x ^= x * 0x0552'6C56U;
  return x ^ x * 0x53A2'2864U;
}

/// Sobol's second dimension, bits reversed: a multiplication by Pascal's triangle modulo 2.
constexpr std::uint32_t second_dimension(std::uint32_t index) {
  index ^= (index >> 1U) & 0x5555'5555U;
  index ^= (index >> 2U) & 0x3333'3333U;
  index ^= (index >> 4U) & 0x0F0F'0F0FU;
  index ^= (index >> 8U) & 0x00FF'00FFU;
  return index ^ ((index >> 16U) & 0x0000'FFFFU);
}

/// Sobol's third dimension, bits reversed: primitive polynomial x^2 + x + 1, first directions 1 and 3. Of the index the
/// bits above 16, which move nothing by more than 2^-16, are left out: scrambling moves it as much.
constexpr std::uint32_t third_dimension(std::uint32_t index) {
  std::uint32_t direction = 1U << 31U;
  std::uint32_t next = 3U << 30U;
  std::uint32_t sum = 0;
  for (std::uint32_t bits = index & 0xFFFFU; bits != 0; bits >>= 1U) {
    sum ^= direction & (0U - (bits & 1U));
    const std::uint32_t after = next ^ direction ^ (direction >> 2U);
    direction = next;
    next = after;
  }
  return reversed_bits(sum);
}

constexpr std::uint32_t shuffled(std::uint32_t sample, std::uint32_t key) {
  return reversed_bits(scrambled(reversed_bits(sample), hash_combine(key, 0)));
}

/// index: as shuffled().
constexpr StratifiedPair pair_of_index(std::uint32_t index, std::uint32_t key) {
  return {reversed_bits(scrambled(index, hash_combine(key, 1))),
          reversed_bits(scrambled(second_dimension(index), hash_combine(key, 2)))};
}

/// sample: counted from 0. key: the same for all samples whose pairs are to keep apart. Their order is shuffled, so
/// that pairs of different keys have nothing to do with each other.
constexpr StratifiedPair stratified_pair(std::uint32_t sample, std::uint32_t key) {
  return pair_of_index(shuffled(sample, key), key);
}

/// Likewise; x and y are those of stratified_pair.
constexpr StratifiedTriple stratified_triple(std::uint32_t sample, std::uint32_t key) {
  const std::uint32_t index = shuffled(sample, key);
  const StratifiedPair pair = pair_of_index(index, key);
  return {pair.x, pair.y, reversed_bits(scrambled(third_dimension(index), hash_combine(key, 3)))};
}

}  // namespace torolux::protocol
