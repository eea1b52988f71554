// SPDX-License-Identifier: MIT
// The primaries of sRGB as exact fractions, and the inverse of their matrix.
#include "host_tools/picture/lightness.hpp"

#include <cmath>

namespace torolux {
namespace {

using Rows = std::array<std::array<double, 3>, 3>;

/// XYZ of the primaries of IEC 61966-2-1 with its white (chromaticities 0.64 0.33, 0.3 0.6, 0.15 0.06; D65: 0.3127
/// 0.3290), which makes display white (1, 1, 1) have Y = 1.
constexpr Rows kToXyz = {{{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                          {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                          {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}}};

constexpr std::array<double, 3> times(const Rows& rows, const std::array<double, 3>& v) {
  std::array<double, 3> result{};
  for (std::size_t i = 0; i < 3; ++i) result[i] = rows[i][0] * v[0] + rows[i][1] * v[1] + rows[i][2] * v[2];
  return result;
}

constexpr std::array<double, 3> kWhite = times(kToXyz, {1, 1, 1});

constexpr Rows inverse(const Rows& m) {
  Rows result{};
  const auto minor = [&](std::size_t i, std::size_t j) {
    const std::size_t a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
    return m[a][c] * m[b][d] - m[a][d] * m[b][c];
  };
  const double determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(0, 1) + m[0][2] * minor(0, 2);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) result[j][i] = minor(i, j) / determinant;
  }
  return result;
}

constexpr Rows kFromXyz = inverse(kToXyz);

}  // namespace

std::array<double, 3> relative_xyz(const std::array<double, 3>& linear) {
  std::array<double, 3> xyz = times(kToXyz, linear);
  for (std::size_t i = 0; i < 3; ++i) xyz[i] /= kWhite[i];
  return xyz;
}

std::array<double, 3> linear_of_xyz(const std::array<double, 3>& relative) {
  return times(kFromXyz, {relative[0] * kWhite[0], relative[1] * kWhite[1], relative[2] * kWhite[2]});
}

std::array<double, 3> lab_of_xyz(const std::array<double, 3>& relative) {
  constexpr double kDelta = 6.0 / 29;
  std::array<double, 3> f{};
  for (std::size_t i = 0; i < 3; ++i) {
    f[i] = relative[i] > kDelta * kDelta * kDelta ? std::cbrt(relative[i])
                                                  : relative[i] / (3 * kDelta * kDelta) + 4.0 / 29;
  }
  return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

}  // namespace torolux
