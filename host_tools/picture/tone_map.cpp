// SPDX-License-Identifier: MIT
// A picture of radiance enters, bytes for a display leave.
#include "host_tools/picture/tone_map.hpp"

#include <algorithm>
#include <cmath>

namespace torolux {
namespace {

/// Strength with which what is far too bright turns white.
constexpr float kDesaturation = 0.15F;

/// Rec. 709 luminance.
double luminance(const std::array<float, 3>& colour) {
  return 0.2126 * double{colour[0]} + 0.7152 * double{colour[1]} + 0.0722 * double{colour[2]};
}

}  // namespace

double middle_luminance(const Picture& picture) {
  std::vector<double> values;
  values.reserve(picture.pixels.size());
  for (const auto& pixel : picture.pixels) {
    const double value = luminance(pixel);
    if (std::isfinite(value) && value > 0) values.push_back(value);
  }
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t tenth = values.size() / 10;
  double sum = 0;
  for (std::size_t i = tenth; i < values.size() - tenth; ++i) sum += std::log2(values[i]);
  return std::exp2(sum / static_cast<double>(values.size() - 2 * tenth));
}

double exposure_factor(const Picture& picture, double exposure_ev) {
  const double middle = middle_luminance(picture);
  return (middle > 0 ? kMiddleGrey / middle : 1.0) * std::exp2(exposure_ev);
}

// After the Khronos PBR Neutral tone mapper (Khronos Group 2024), with an earlier shoulder and without its offset for
// Fresnel reflections. All channels are scaled alike, then moved towards white: both keep the hue.
std::array<float, 3> compress(const std::array<float, 3>& colour) {
  std::array<float, 3> c{};
  for (std::size_t i = 0; i < 3; ++i) c[i] = std::isfinite(colour[i]) ? std::max(colour[i], 0.0F) : 0.0F;
  const float peak = std::max({c[0], c[1], c[2]});
  if (peak <= kShoulder) return c;
  constexpr float room = 1.0F - kShoulder;
  const float new_peak = 1.0F - room * room / (peak + room - kShoulder);
  const float white = 1.0F - 1.0F / (kDesaturation * (peak - new_peak) + 1.0F);
  for (float& channel : c) {
    const float scaled = channel / peak * new_peak;
    channel = scaled + (new_peak - scaled) * white;
  }
  return c;
}

std::uint8_t to_srgb(float linear) {
  const double value = std::clamp(double{linear}, 0.0, 1.0);
  const double encoded = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * encoded));
}

std::vector<std::uint8_t> tone_map(const Picture& picture, double exposure_ev) {
  const double factor = exposure_factor(picture, exposure_ev);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(picture.pixels.size() * 3);
  for (const auto& pixel : picture.pixels) {
    std::array<float, 3> exposed{};
    for (std::size_t c = 0; c < 3; ++c) exposed[c] = static_cast<float>(double{pixel[c]} * factor);
    for (const float channel : compress(exposed)) bytes.push_back(to_srgb(channel));
  }
  return bytes;
}

}  // namespace torolux
