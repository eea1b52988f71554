// SPDX-License-Identifier: MIT
// Each model is a product of what depends on the height above the horizon and what depends on the angle to the sun.
#include "host_tools/scene/sky_models.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host_tools/colour/colour.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

double angle_between(const Vec3d& a, const Vec3d& b) {
  return std::acos(std::clamp(vec::dot(a, b), -1.0, 1.0));
}

/// Perez, Seals & Michalsky 1993. height: the sine of the elevation; sun_angle: to the sun [radian].
struct Perez {
  double a, b, c, d, e;
  double operator()(double height, double sun_angle) const {
    const double cosine = std::cos(sun_angle);
    return (1 + a * std::exp(b / std::max(height, 1e-3))) * (1 + c * std::exp(d * sun_angle) + e * cosine * cosine);
  }
};

/// Preetham's coefficients: linear in the turbidity.
Perez perez(const std::array<std::array<double, 2>, 5>& by_turbidity, double turbidity) {
  const auto at = [&](std::size_t i) { return by_turbidity[i][0] * turbidity + by_turbidity[i][1]; };
  return {at(0), at(1), at(2), at(3), at(4)};
}

/// Chromaticity at the zenith: rows by the turbidity's square, itself, 1; columns by the sun's zenith angle's cube,
/// square, itself, 1.
double zenith_colour(const std::array<std::array<double, 4>, 3>& matrix, double turbidity, double angle) {
  const std::array<double, 3> rows{turbidity * turbidity, turbidity, 1};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
    sum += rows[i] * (((matrix[i][0] * angle + matrix[i][1]) * angle + matrix[i][2]) * angle + matrix[i][3]);
  return sum;
}

}  // namespace

SkyModel uniform_sky(const Vec3d& radiance) {
  return [radiance](const Vec3d& way) { return way[2] > 0 ? radiance : Vec3d{0, 0, 0}; };
}

SkyModel overcast_sky(const Vec3d& zenith) {
  return [zenith](const Vec3d& way) { return way[2] > 0 ? vec::scale(zenith, (1 + 2 * way[2]) / 3) : Vec3d{0, 0, 0}; };
}

SkyModel clear_sky(const Vec3d& zenith, const Vec3d& sun) {
  // The indicatrix is 1 at a right angle to the sun.
  const auto value = [](double height, double sun_angle) {
    const double cosine = std::cos(sun_angle);
    const double indicatrix =
        1 + 10 * (std::exp(-3 * sun_angle) - std::exp(-3 * std::numbers::pi / 2)) + 0.45 * cosine * cosine;
    return (1 - std::exp(-0.32 / std::max(height, 1e-3))) * indicatrix;
  };
  const double at_zenith = value(1, angle_between({0, 0, 1}, sun));
  return [=](const Vec3d& way) {
    if (!(way[2] > 0)) return Vec3d{0, 0, 0};
    return vec::scale(zenith, value(way[2], angle_between(way, sun)) / at_zenith);
  };
}

SkyModel preetham_sky(double turbidity, const Vec3d& sun) {
  const Perez bright = perez(
      {{{0.1787, -1.4630}, {-0.3554, 0.4275}, {-0.0227, 5.3251}, {0.1206, -2.5771}, {-0.0670, 0.3703}}}, turbidity);
  const Perez x = perez(
      {{{-0.0193, -0.2592}, {-0.0665, 0.0008}, {-0.0004, 0.2125}, {-0.0641, -0.8989}, {-0.0033, 0.0452}}}, turbidity);
  const Perez y = perez(
      {{{-0.0167, -0.2608}, {-0.0950, 0.0092}, {-0.0079, 0.2102}, {-0.0441, -1.6537}, {-0.0109, 0.0529}}}, turbidity);
  const double angle = angle_between({0, 0, 1}, sun);
  const double chi = (4.0 / 9 - turbidity / 120) * (std::numbers::pi - 2 * angle);
  // [cd/m^2]
  const double zenith =
      std::max(0.0, 1000 * ((4.0453 * turbidity - 4.9710) * std::tan(chi) - 0.2155 * turbidity + 2.4192));
  const double zenith_x = zenith_colour({{{0.00166, -0.00375, 0.00209, 0},
                                          {-0.02903, 0.06377, -0.03202, 0.00394},
                                          {0.11693, -0.21196, 0.06052, 0.25886}}},
                                        turbidity, angle);
  const double zenith_y = zenith_colour({{{0.00275, -0.00610, 0.00317, 0},
                                          {-0.04214, 0.08970, -0.04153, 0.00516},
                                          {0.15346, -0.26756, 0.06670, 0.26688}}},
                                        turbidity, angle);
  return [=](const Vec3d& way) {
    if (!(way[2] > 0)) return Vec3d{0, 0, 0};
    const double to_sun = angle_between(way, sun);
    const auto at = [&](const Perez& model, double value) { return value * model(way[2], to_sun) / model(1, angle); };
    const double brightness = at(bright, zenith) / kLumenPerWatt;
    return brightness > 0 ? linear_colour({at(x, zenith_x), at(y, zenith_y)}, brightness).rgb : Vec3d{0, 0, 0};
  };
}

}  // namespace torolux
