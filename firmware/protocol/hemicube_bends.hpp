// SPDX-License-Identifier: MIT
// How light is spread over a hemi-cube's pixels. Enters: an entry's number in the table; leaves: the bends of the
// polynomials that turn even random numbers into places in the pixel. Made once, before a stage; by + - * / of doubles
// alone, so that every computer makes the same table.
#pragma once

#include <array>
#include <cstdint>

namespace torolux::protocol {

/// A place in one direction of a pixel: size * (u + u (1 - u) (p + q u)), u even in [0, 1). With it the parts of the
/// pixel's light below the places at u = 1/4 and 3/4 are exactly these. At 8 pixels across, the density so made is off
/// by at most 0.8 % anywhere in a pixel of the top, at 4 by 6 %; over each pixel by nothing.
struct Bend {
  float p, q;
};

/// An entry of the hemi-cube's table.
struct HemicubeEntry {
  std::uint32_t weight;  ///< delta form factor as a fraction of 2^32
  Bend first;            ///< of the direction that is chosen first: top: from row to row; side: along a row
  Bend second;           ///< top: along the row, at the pixel's inner edge; side: none, z has a closed form
  Bend second_by;        ///< top: added to `second` at the pixel's outer edge, and in proportion in between
};
static_assert(sizeof(HemicubeEntry) == 28);

namespace bends {

/// Gauss-Legendre's rule of five points over [a, b]: exact for polynomials up to degree 9.
template <class Function>
constexpr double integral(const Function& f, double a, double b) {
  constexpr std::array<double, 3> at{0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr std::array<double, 3> weight{0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  const double middle = 0.5 * (a + b);
  const double half = 0.5 * (b - a);
  double sum = weight[0] * f(middle);
  for (std::size_t i = 1; i < 3; ++i) sum += weight[i] * (f(middle - half * at[i]) + f(middle + half * at[i]));
  return half * sum;
}

/// f: density over [a, b], of any scale.
template <class Function>
constexpr Bend bend(const Function& f, double a, double b) {
  const double all = integral(f, a, b);
  const auto place = [&](double u) {  // in units of the size: Newton's method, from an even density on
    double x = a + (b - a) * u;
    for (int step = 0; step < 4; ++step) x -= (integral(f, a, x) - all * u) / f(x);
    return (x - a) / (b - a);
  };
  // p + q / 4 and p + 3 q / 4.
  const double low = (place(0.25) - 0.25) * (16.0 / 3.0);
  const double high = (place(0.75) - 0.75) * (16.0 / 3.0);
  return {static_cast<float>(1.5 * low - 0.5 * high), static_cast<float>(2.0 * (high - low))};
}

}  // namespace bends

/// Of the pixel [i, i + 1] x [j, j + 1] of the top's quadrant, all but its weight. Its density is
/// 1 / (1 + x^2 + y^2)^2.
constexpr HemicubeEntry top_entry(std::uint32_t n, std::uint32_t i, std::uint32_t j) {
  const double size = 2.0 / n;
  const double x0 = i * size;
  const double y0 = j * size;
  const auto along = [](double y) {
    return [y](double x) {
      const double square = 1.0 + x * x + y * y;
      return 1.0 / (square * square);
    };
  };
  const auto across = [&](double y) { return bends::integral(along(y), x0, x0 + size); };
  const Bend inner = bends::bend(along(y0), x0, x0 + size);
  const Bend outer = bends::bend(along(y0 + size), x0, x0 + size);
  return {0, bends::bend(across, y0, y0 + size), inner, {outer.p - inner.p, outer.q - inner.q}};
}

/// Likewise of a side, i outwards and j up: z / (1 + y^2 + z^2)^2, of which z has a closed form.
constexpr HemicubeEntry side_entry(std::uint32_t n, std::uint32_t i, std::uint32_t j) {
  const double size = 2.0 / n;
  const double low = j * size * (j * size);
  const double high = (j + 1) * size * ((j + 1) * size);
  const auto across = [&](double y) { return 1.0 / (1.0 + y * y + low) - 1.0 / (1.0 + y * y + high); };
  return {0, bends::bend(across, i * size, (i + 1) * size), {}, {}};
}

/// The table's entry of this number (hemicube_weights, stores.hpp), all but its weight.
constexpr HemicubeEntry hemicube_entry(std::uint32_t n, std::uint32_t number) {
  const std::uint32_t half = n / 2U;
  const std::uint32_t row = number / half;
  const std::uint32_t i = number - row * half;
  return row < half ? top_entry(n, i, row) : side_entry(n, i, row - half);
}

}  // namespace torolux::protocol
