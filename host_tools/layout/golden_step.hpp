// SPDX-License-Identifier: MIT
// An order in which neighbours lie far apart: 0, s, 2s, ... modulo the count.
#pragma once

#include <cstdint>
#include <numeric>

namespace torolux {

/// A step of about the golden section of `count`, which shares no divisor with it: taken round and round it comes to
/// each of `count` things once, and to neighbours far apart in time. count > 0.
inline std::uint64_t golden_step(std::uint64_t count) {
  auto step = static_cast<std::uint64_t>(static_cast<double>(count) * 0.6180339887498949);
  step = step == 0 ? 1 : step;
  while (std::gcd(step, count) != 1) ++step;
  return step;
}

}  // namespace torolux
