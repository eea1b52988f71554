// SPDX-License-Identifier: MIT
// All samples of a picture in one row: pixels along a curve that fills it, each with all of its samples.
#pragma once

#include <bit>
#include <cstdint>

namespace torolux::protocol {

/// Bit i of x, 0..65535, becomes bit 2 i.
constexpr std::uint32_t spread_bits(std::uint32_t x) {
  x = (x | (x << 8U)) & 0x00FF'00FFU;
  x = (x | (x << 4U)) & 0x0F0F'0F0FU;
  x = (x | (x << 2U)) & 0x3333'3333U;
  return (x | (x << 1U)) & 0x5555'5555U;
}

/// Place in the row of a sample, 0..samples - 1, of one pixel. Pixels lie along Morton's curve (1966), each in as many
/// places as the next power of 2 of `samples`, so that all squares of 2^n x 2^n pixels begin at a multiple of their
/// places: numbers of a (0,2)-sequence keep apart over the samples of a pixel, and over those of each such square. What
/// is wrong in one pixel is then made good by its neighbours: the error becomes grain as fine as pixels (A. Ahmed, P.
/// Wonka, "Screen-space blue-noise diffusion of Monte Carlo sampling error via hierarchical ordering of pixels", 2020).
/// In pictures of more than 2^32 samples places far from each other are the same.
constexpr std::uint32_t place_in_picture(std::uint32_t column, std::uint32_t row, std::uint32_t sample,
                                         std::uint32_t samples) {
  const auto bits = static_cast<std::uint32_t>(std::bit_width(samples - 1U));
  return ((spread_bits(column) | (spread_bits(row) << 1U)) << bits) | sample;
}

}  // namespace torolux::protocol
