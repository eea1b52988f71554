// SPDX-License-Identifier: MIT
// Colorimetry: spectrum to XYZ to linear RGB.
#include "host_tools/colour/colour.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/colour/cie_observer.hpp"

namespace torolux {
namespace {

/// XYZ relative to D65 into linear sRGB (IEC 61966-2-1).
constexpr std::array<Triple, 3> kFromXyz{
    {{3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}}};
/// White of equal energy to D65 (Bradford; B. Lindbloom's figures).
constexpr std::array<Triple, 3> kAdapted{
    {{0.9531874, -0.0265906, 0.0238731}, {-0.0382467, 1.0288406, 0.0094060}, {0.0026068, -0.0030332, 1.0892565}}};
constexpr Triple kLuminance{0.2126, 0.7152, 0.0722};

double dot(const Triple& a, const Triple& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Triple times(const std::array<Triple, 3>& m, const Triple& v) {
  return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}

/// In steps of 1 nm, the observer straight between its values.
Triple integral(const std::function<double(double)>& spectrum) {
  Triple sum{0, 0, 0};
  constexpr std::size_t last = kObserver.size() - 1;
  for (std::size_t i = 0; i < last; ++i)
    for (int k = 0; k < static_cast<int>(kObserverStep) + (i + 1 == last ? 1 : 0); ++k) {
      const double part = k / kObserverStep;
      const double nanometers = kFirstNanometer + kObserverStep * static_cast<double>(i) + k;
      const double value = spectrum(nanometers);
      for (std::size_t c = 0; c < 3; ++c) sum[c] += value * (kObserver[i][c] * (1 - part) + kObserver[i + 1][c] * part);
    }
  return sum;
}

}  // namespace

Triple tristimulus(const std::function<double(double)>& spectrum) {
  static const Triple white = integral([](double) { return 1.0; });
  const Triple sum = integral(spectrum);
  return {sum[0] / white[0], sum[1] / white[1], sum[2] / white[2]};
}

Triple tristimulus(double first, double last, std::span<const double> values) {
  return tristimulus([&](double nanometers) {
    if (nanometers < first || nanometers > last) return 0.0;
    const double at = (nanometers - first) / (last - first) * static_cast<double>(values.size() - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(at), values.size() - 2);
    const double part = at - static_cast<double>(i);
    return values[i] * (1 - part) + values[i + 1] * part;
  });
}

Triple black_body(double kelvin) {
  constexpr double c2 = 14388e3;  // nm K
  // Relative to 560 nm, so that no temperature leaves the range of numbers.
  const auto exponent = [kelvin](double nanometers) { return c2 / (nanometers * kelvin); };
  const double at_560 = exponent(560);
  return tristimulus([&](double nanometers) {
    const double e = exponent(nanometers);
    return std::pow(560 / nanometers, 5) * std::exp(at_560 - e) * (-std::expm1(-at_560)) / (-std::expm1(-e));
  });
}

Chromaticity chromaticity(const Triple& xyz) {
  const double sum = xyz[0] + xyz[1] + xyz[2];
  return {xyz[0] / sum, xyz[1] / sum};
}

Triple tristimulus(const Chromaticity& colour, double luminance) {
  return {colour.x / colour.y * luminance, luminance, (1 - colour.x - colour.y) / colour.y * luminance};
}

double luminance(const Triple& rgb) {
  return dot(kLuminance, rgb);
}

LinearColour linear_colour(const Chromaticity& colour, double luminance_wanted) {
  const Triple white = times(kFromXyz, times(kAdapted, {1, 1, 1}));
  LinearColour result{times(kFromXyz, times(kAdapted, tristimulus(colour, 1)))};
  for (std::size_t c = 0; c < 3; ++c) {
    result.rgb[c] /= white[c];
    if (result.rgb[c] < -1e-6) result.clipped = true;
    result.rgb[c] = std::max(result.rgb[c], 0.0);
  }
  const double brightness = luminance(result.rgb);
  if (brightness > 0)
    for (double& channel : result.rgb) channel *= luminance_wanted / brightness;
  return result;
}

}  // namespace torolux
