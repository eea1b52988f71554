// SPDX-License-Identifier: MIT
// Sine and cosine of small angles: an angle enters, both leave, by their series, so that every machine computes the
// same bits.
#pragma once

namespace torolux::protocol {

struct SineCosine {
  float sine, cosine;
};

/// Of an angle of at most an eighth of a turn [radian]; errors below 3e-8.
constexpr SineCosine sine_cosine(float a) {
  const float q = a * a;
  return {a * (1.0F - q * (1.0F / 6.0F - q * (1.0F / 120.0F - q * (1.0F / 5040.0F - q * (1.0F / 362880.0F))))),
          1.0F - q * (0.5F - q * (1.0F / 24.0F - q * (1.0F / 720.0F - q * (1.0F / 40320.0F))))};
}

}  // namespace torolux::protocol
