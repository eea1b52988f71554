// SPDX-License-Identifier: MIT
// The sun's disc is a cone of 0.2665 degrees about its middle. Openings are chosen by area over the distance's square.
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
constexpr int kBands = 32, kSectors = 64, kHorizon = kBands / 2;

Vec vector_of(const Vec3d& v) {
  return {v[0], v[1], v[2]};
}

Colour cell(const Sky& sky, int band, int sector) {
  const Vec3d& radiance = sky.radiance[static_cast<std::size_t>(band) * kSectors + static_cast<std::size_t>(sector)];
  return {radiance[0], radiance[1], radiance[2]};
}

double area(const SkyQuad& opening) {
  return vector_of(opening.along).cross(vector_of(opening.across)).norm();
}

/// How often an opening is chosen, in proportion.
double expected(const SkyQuad& opening, const Vec& point) {
  const Vec middle = vector_of(opening.corner) + (vector_of(opening.along) + vector_of(opening.across)) / 2;
  return area(opening) / ((middle - point).squaredNorm() + area(opening));
}

/// Of directions from `point` that are drawn evenly over the opening [1/sr].
double density_over(const SkyQuad& opening, const Vec& point, const Vec& direction) {
  const Vec along = vector_of(opening.along);
  const Vec across = vector_of(opening.across);
  const Vec inwards = along.cross(across);
  const double towards = -direction.dot(inwards);
  if (!(towards > 0)) return 0;
  const Vec way = vector_of(opening.corner) - point;
  const double distance = -way.dot(inwards) / towards;
  if (!(distance > 0)) return 0;
  const Vec there = direction * distance - way;
  const double a = there.cross(across).dot(inwards) / inwards.squaredNorm();
  const double b = along.cross(there).dot(inwards) / inwards.squaredNorm();
  return a >= 0 && a <= 1 && b >= 0 && b <= 1 ? distance * distance / towards : 0;
}

}  // namespace

DistantLight::DistantLight(const Sky& sky)
    : from_(sky),
      east_(vector_of(sky.east)),
      north_(vector_of(sky.north)),
      up_(vector_of(sky.up)),
      sun_(vector_of(sky.sun)),
      sun_irradiance_(sky.sun_irradiance[0], sky.sun_irradiance[1], sky.sun_irradiance[2]) {}

/// 0 to kSectors, once around.
double DistantLight::sector(const Vec& direction) const {
  double angle = std::atan2(direction.dot(north_), direction.dot(east_));
  if (angle < 0) angle += 2 * kPi;
  const double quarter = std::min(3.0, std::floor(angle / (kPi / 2)));
  const double in_quarter = angle - quarter * (kPi / 2);
  // Along the side of the square |x| + |y| = 1.
  const double side = std::sin(in_quarter) / (std::sin(in_quarter) + std::cos(in_quarter));
  return (quarter + side) / 4 * kSectors;
}

Colour DistantLight::sky(const Vec& direction) const {
  const int band = std::clamp(static_cast<int>(std::floor((direction.dot(up_) + 1) / 2 * kBands)), 0, kBands - 1);
  return cell(from_, band, std::min(static_cast<int>(sector(direction)), kSectors - 1));
}

Colour DistantLight::sky_shown(const Vec& direction) const {
  const double height = direction.dot(up_);
  const int first = height < 0 ? 0 : kHorizon;
  const int last = first + kHorizon - 1;
  const double row = std::clamp<double>((height + 1) / 2 * kBands - 0.5, first, last);
  const int below = static_cast<int>(row);
  const int above = std::min(below + 1, last);
  const double column = sector(direction) + kSectors - 0.5;
  const int left = static_cast<int>(column);
  const double right_part = column - left;
  const auto in_row = [&](int band) -> Colour {
    return cell(from_, band, left % kSectors) * (1 - right_part) +
           cell(from_, band, (left + 1) % kSectors) * right_part;
  };
  return in_row(below) * (1 - (row - below)) + in_row(above) * (row - below);
}

Colour DistantLight::sun(const Vec& direction) const {
  if (!has_sun() || direction.dot(sun_) < kCosine) return Colour::Zero();
  return sun_irradiance_ / (kPi * (1 - kCosine * kCosine));
}

Vec DistantLight::to_sun(const std::array<double, 2>& place) const {
  return around(sun_, std::sqrt(1 - place[0] * (1 - kCosine * kCosine)), place[1]);
}

Vec DistantLight::to_opening(const Vec& point, double pick, const std::array<double, 2>& place) const {
  double all = 0;
  for (const SkyQuad& opening : from_.openings) all += expected(opening, point);
  double rest = pick * all;
  const SkyQuad* chosen = &from_.openings.back();
  for (const SkyQuad& opening : from_.openings) {
    rest -= expected(opening, point);
    if (rest >= 0) continue;
    chosen = &opening;
    break;
  }
  const Vec target =
      vector_of(chosen->corner) + vector_of(chosen->along) * place[0] + vector_of(chosen->across) * place[1];
  return (target - point).normalized();
}

double DistantLight::opening_density(const Vec& point, const Vec& direction) const {
  double all = 0;
  double sum = 0;
  for (const SkyQuad& opening : from_.openings) {
    const double chosen = expected(opening, point);
    all += chosen;
    sum += chosen * density_over(opening, point, direction);
  }
  return sum / all;
}

}  // namespace torolux::references
