// SPDX-License-Identifier: MIT
// Vectors of the stores enter; their products and sums leave, with the same roundings on the host and every PE.
#pragma once

#include "firmware/protocol/records.hpp"

namespace torolux::protocol {

constexpr float dot(const Vec3f& a, const Vec3f& b) {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}
constexpr Vec3f combined(const Vec3f& a, float by_a, const Vec3f& b, float by_b, const Vec3f& c, float by_c) {
  return {(a[0] * by_a + b[0] * by_b) + c[0] * by_c, (a[1] * by_a + b[1] * by_b) + c[1] * by_c,
          (a[2] * by_a + b[2] * by_b) + c[2] * by_c};
}

}  // namespace torolux::protocol
