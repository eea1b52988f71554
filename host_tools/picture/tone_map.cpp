// SPDX-License-Identifier: MIT
// A picture of radiance enters, bytes for a display leave.
#include "host_tools/picture/tone_map.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/picture/white_balance.hpp"

namespace torolux {
namespace {

/// Steepness of toe and shoulder: 1 would have no toe.
constexpr double kContrast = 1.3;
/// Strength with which what is brighter than display white turns white.
constexpr double kDesaturation = 0.15;

/// Toe and shoulder in one: x^a / (b x^a + c), b and c such that middle grey stays and kWhite becomes 1 (T. Lottes,
/// Advanced Techniques and Optimization of HDR Color Tonemapping, GDC 2016, with a shoulder of 1; in the study of
/// vision it is the Naka-Rushton curve).
double filmic(double x) {
  static const double c = (std::pow(kMiddleGrey, kContrast - 1) - std::pow(kMiddleGrey, kContrast)) /
                          (1 - std::pow(kMiddleGrey / kWhite, kContrast));
  static const double b = 1 - c * std::pow(kWhite, -kContrast);
  const double power = std::pow(std::min(x, kWhite), kContrast);
  return power / (b * power + c);
}

}  // namespace

double luminance(const std::array<float, 3>& colour) {
  return 0.2126 * double{colour[0]} + 0.7152 * double{colour[1]} + 0.0722 * double{colour[2]};
}

std::vector<double> measured_luminances(const Picture& picture) {
  std::vector<double> values;
  values.reserve(picture.pixels.size());
  for (const auto& pixel : picture.pixels) {
    const double value = luminance(pixel);
    if (std::isfinite(value) && value > 0) values.push_back(value);
  }
  std::sort(values.begin(), values.end());
  const auto tenth = static_cast<std::ptrdiff_t>(values.size() / 10);
  return {values.begin() + tenth, values.end() - tenth};
}

double middle_luminance(const Picture& picture) {
  const std::vector<double> values = measured_luminances(picture);
  if (values.empty()) return 0;
  double sum = 0;
  for (const double value : values) sum += std::log2(value);
  return std::exp2(sum / static_cast<double>(values.size()));
}

double exposure_factor(const Picture& picture, double exposure_ev) {
  const double middle = middle_luminance(picture);
  return (middle > 0 ? kMiddleGrey / middle : 1.0) * std::exp2(exposure_ev);
}

// The curve is that of the brightest channel; all are scaled alike, then moved towards white (after the Khronos PBR
// Neutral tone mapper, Khronos Group 2024): both keep the hue, which a curve for each channel would not.
std::array<float, 3> compress(const std::array<float, 3>& colour, ToneCurve curve) {
  std::array<float, 3> c{};
  for (std::size_t i = 0; i < 3; ++i) c[i] = std::isfinite(colour[i]) ? std::max(colour[i], 0.0F) : 0.0F;
  const double peak = double{std::max({c[0], c[1], c[2]})};
  if (peak == 0) return c;
  const double new_peak = curve == ToneCurve::filmic ? filmic(peak) : peak;
  const double white = curve == ToneCurve::filmic ? 1 - 1 / (kDesaturation * std::max(peak - 1, 0.0) + 1) : 0;
  for (float& channel : c) {
    const double scaled = double{channel} / peak * new_peak;
    channel = static_cast<float>(std::min(scaled + (new_peak - scaled) * white, 1.0));
  }
  return c;
}

std::uint8_t to_srgb(float linear) {
  const double value = std::clamp(double{linear}, 0.0, 1.0);
  const double encoded = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * encoded));
}

Picture shown(const Picture& picture, double factor, ToneCurve curve) {
  Picture result{picture.width, picture.height, {}};
  result.pixels.reserve(picture.pixels.size());
  for (const auto& pixel : picture.pixels) {
    std::array<float, 3> exposed{};
    for (std::size_t c = 0; c < 3; ++c) exposed[c] = static_cast<float>(double{pixel[c]} * factor);
    result.pixels.push_back(compress(exposed, curve));
  }
  return result;
}

std::vector<std::uint8_t> tone_map(const Picture& picture, const ToneMapping& mapping) {
  if (const auto changed = balanced(picture, mapping.white)) return tone_map(*changed, without_balance(mapping));
  const double factor = exposure_factor(picture, mapping.exposure_ev);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(picture.pixels.size() * 3);
  for (const auto& pixel : picture.pixels) {
    std::array<float, 3> exposed{};
    for (std::size_t c = 0; c < 3; ++c) exposed[c] = static_cast<float>(double{pixel[c]} * factor);
    for (const float channel : compress(exposed, mapping.curve)) bytes.push_back(to_srgb(channel));
  }
  return bytes;
}

}  // namespace torolux
