// SPDX-License-Identifier: MIT
// The sun's disc is a cone of 0.2665 degrees about its middle.
#include "tests/references/distant_light.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace torolux::references {
namespace {

constexpr double kPi = std::numbers::pi;
const double kCosine = std::cos(0.2665 * kPi / 180);
/// The table's cells: 32 bands of height, 64 sectors.
constexpr int kBands = 32, kSectors = 64;

Vec vector_of(const Vec3d& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

DistantLight::DistantLight(const Sky& sky)
    : from_(sky),
      east_(vector_of(sky.east)),
      north_(vector_of(sky.north)),
      up_(vector_of(sky.up)),
      sun_(vector_of(sky.sun)),
      sun_irradiance_(sky.sun_irradiance[0], sky.sun_irradiance[1], sky.sun_irradiance[2]) {}

Colour DistantLight::sky(const Vec& direction) const {
  const int band = std::clamp(static_cast<int>(std::floor((direction.dot(up_) + 1) / 2 * kBands)), 0, kBands - 1);
  double angle = std::atan2(direction.dot(north_), direction.dot(east_));
  if (angle < 0) angle += 2 * kPi;
  const double quarter = std::min(3.0, std::floor(angle / (kPi / 2)));
  const double in_quarter = angle - quarter * (kPi / 2);
  // Along the side of the square |x| + |y| = 1.
  const double side = std::sin(in_quarter) / (std::sin(in_quarter) + std::cos(in_quarter));
  const int sector = std::min(static_cast<int>((quarter + side) * (kSectors / 4)), kSectors - 1);
  const Vec3d& radiance = from_.radiance[static_cast<std::size_t>(band * kSectors + sector)];
  return {radiance[0], radiance[1], radiance[2]};
}

Colour DistantLight::sun(const Vec& direction) const {
  if (!has_sun() || direction.dot(sun_) < kCosine) return Colour::Zero();
  return sun_irradiance_ / (kPi * (1 - kCosine * kCosine));
}

Vec DistantLight::to_sun(const std::array<double, 2>& place) const {
  return around(sun_, std::sqrt(1 - place[0] * (1 - kCosine * kCosine)), place[1]);
}

}  // namespace torolux::references
