// SPDX-License-Identifier: MIT
// Two random numbers, height and turn about the lobe's axis, enter; a direction and its cosine leave. Logarithm and
// exponential are series, so that every machine computes the same bits.
#include "firmware/pe/glossy.hpp"

#include <cmath>

#include "firmware/pe/specular.hpp"

namespace torolux::pe {
namespace {

/// ln(u), u in 2^-24..1; relative error below 3e-7, near 1 as well.
float logarithm(float u) {
  constexpr std::int32_t root_half = 0x3F35'04F3;
  const std::int32_t above = bits(u) - root_half;
  const std::int32_t exponent = above >> 23;
  const float m = std::bit_cast<float>((above & 0x007F'FFFF) + root_half);  // 0.707..1.414
  const float s = (m - 1.0F) / (m + 1.0F);
  const float q = s * s;
  const float of_m = 2.0F * s * (1.0F + q * (1.0F / 3.0F + q * (1.0F / 5.0F + q * (1.0F / 7.0F + q * (1.0F / 9.0F)))));
  return static_cast<float>(exponent) * 0.693147181F + of_m;
}

/// e^x - 1, x in -17..0; relative error below 3e-7, near 0 as well.
float exponential_less_one(float x) {
  const auto halvings = static_cast<std::int32_t>(0.5F - x * 1.44269504F);
  const auto k = static_cast<float>(halvings);
  const float r = (x + k * 0.693359375F) - k * 2.12194440e-4F;  // ln 2 in two parts: the first times k is exact
  const float of_r =
      r *
      (1.0F + r * (0.5F + r * (1.0F / 6.0F +
                               r * (1.0F / 24.0F + r * (1.0F / 120.0F + r * (1.0F / 720.0F + r * (1.0F / 5040.0F)))))));
  const float scale = std::bit_cast<float>((127 - halvings) << 23);
  return (scale - 1.0F) + scale * of_r;
}

}  // namespace

glm::vec3 around(const glm::vec3& axis, float power, float height, float turn) {
  // Of cos(alpha) = (1 - height)^power, less one: so that a narrow lobe's sine keeps its digits.
  const float less_one = exponential_less_one(logarithm(1.0F - height) * power);
  const float sine = std::sqrt(-less_one * (2.0F + less_one));
  const float quarters = turn * 4.0F;
  const auto quarter = static_cast<std::int32_t>(quarters);
  const SineCosine in_quarter = sine_cosine(((quarters - static_cast<float>(quarter)) - 0.5F) * 1.57079633F);
  float x = (quarter & 1) == 0 ? in_quarter.cosine : -in_quarter.sine;
  float y = (quarter & 1) == 0 ? in_quarter.sine : in_quarter.cosine;
  if (quarter >= 2) {
    x = -x;
    y = -y;
  }
  // Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
  const float sign = bits(axis.z) < 0 ? -1.0F : 1.0F;
  const float a = -1.0F / (sign + axis.z);
  const float b = axis.x * axis.y * a;
  const glm::vec3 across(1.0F + sign * axis.x * axis.x * a, sign * b, -sign * axis.x);
  const glm::vec3 up(b, sign + axis.y * axis.y * a, -axis.y);
  return glm::normalize((across * (sine * x) + up * (sine * y)) + axis * (1.0F + less_one));
}

LobeSample sample_lobe(const protocol::Material& material, const glm::vec3& in, const glm::vec3& geometric,
                       const glm::vec3& shading, float height, float turn) {
  const glm::vec3 direction = around(reflect(in, geometric, shading), material.lobe_power, height, turn);
  const float cosine = glm::dot(direction, geometric);
  return {direction, glm::dot(in, geometric) > 0.0F ? -cosine : cosine};
}

}  // namespace torolux::pe
