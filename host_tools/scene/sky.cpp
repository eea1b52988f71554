// SPDX-License-Identifier: MIT
// Means over cells of equal solid angle by points that are even in height and turn.
#include "host_tools/scene/sky.hpp"

#include <cmath>
#include <numbers>

#include "firmware/protocol/sky.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

using protocol::kSkyBands;
using protocol::kSkyCells;
using protocol::kSkySectors;

/// Points of a cell, along height and turn.
constexpr std::uint32_t kPoints = 8;

/// at: 0..1 within the cell, up and along. Unit length, in the sky's frame.
Vec3d direction_in(std::size_t cell, double up, double along) {
  const std::size_t band = cell / kSkySectors;
  const double height = (static_cast<double>(band) + up) * (2.0 / kSkyBands) - 1;
  const double turn = (static_cast<double>(cell % kSkySectors) + along) * (4.0 / kSkySectors);
  const double quarter = std::floor(turn);
  // The angle of the place on the square |x| + |y| = 1.
  const double angle = quarter * (std::numbers::pi / 2) + std::atan2(turn - quarter, 1 - (turn - quarter));
  const double out = std::sqrt(std::max(0.0, 1 - height * height));
  return {std::cos(angle) * out, std::sin(angle) * out, height};
}

/// How much of a cell's solid angle lies about a point of it, over the mean.
double weight_along(std::size_t cell, double along) {
  const double turn = (static_cast<double>(cell % kSkySectors) + along) * (4.0 / kSkySectors);
  const double part = turn - std::floor(turn);
  return 1 / (part * part + (1 - part) * (1 - part));
}

/// visit(direction in the sky's frame, weight); a cell's weights add up to 1.
template <class Visit>
void for_each_point(std::size_t cell, const Visit& visit) {
  double sum = 0;
  for (std::uint32_t j = 0; j < kPoints; ++j) sum += weight_along(cell, (j + 0.5) / kPoints) * kPoints;
  for (std::uint32_t j = 0; j < kPoints; ++j) {
    const double along = (j + 0.5) / kPoints;
    for (std::uint32_t i = 0; i < kPoints; ++i)
      visit(direction_in(cell, (i + 0.5) / kPoints, along), weight_along(cell, along) / sum);
  }
}

}  // namespace

Vec3d sky_direction(const Sky& sky, double elevation, double azimuth) {
  const double up = elevation * (std::numbers::pi / 180);
  const double turn = azimuth * (std::numbers::pi / 180);
  const Vec3d level = vec::add(vec::scale(sky.east, std::sin(turn)), vec::scale(sky.north, std::cos(turn)));
  return vec::add(vec::scale(level, std::cos(up)), vec::scale(sky.up, std::sin(up)));
}

void include_openings(const Scene& scene, vec::Box& box) {
  if (!scene.sky) return;
  for (const SkyQuad& opening : scene.sky->openings) include_opening(opening, box);
}

void include_opening(const SkyQuad& opening, vec::Box& box) {
  for (const Vec3d& near : {opening.corner, vec::add(opening.corner, opening.along)}) {
    box.include(near);
    box.include(vec::add(near, opening.across));
  }
}

std::vector<Vec3d> sky_table(const std::function<Vec3d(const Vec3d&)>& radiance) {
  std::vector<Vec3d> table(kSkyCells, Vec3d{0, 0, 0});
  for (std::size_t cell = 0; cell < table.size(); ++cell) {
    for_each_point(cell, [&](const Vec3d& direction, double weight) {
      table[cell] = vec::add(table[cell], vec::scale(radiance(direction), weight));
    });
  }
  return table;
}

void take_suns(const std::vector<ImportedSun>& suns, std::optional<Sky>& sky, Notices& notices) {
  for (const ImportedSun& sun : suns) {
    if (sky && vec::largest(sky->sun_irradiance) > 0) {
      notices.note("one sun shines: scene.toml's, or the first; this one (directional light) is not rendered",
                   sun.place);
      continue;
    }
    if (!sky) {
      sky.emplace();
      sky->radiance.assign(kSkyCells, Vec3d{0, 0, 0});
    }
    sky->sun = vec::unit(sun.direction);
    sky->sun_irradiance = sun.irradiance;
  }
}

double sky_sector_begin(std::size_t sector) {
  constexpr std::size_t kQuarter = kSkySectors / 4;
  const std::size_t quarter = sector / kQuarter;
  const double part = static_cast<double>(sector % kQuarter) / kQuarter;
  return static_cast<double>(quarter) * (std::numbers::pi / 2) + std::atan2(part, 1 - part);
}

double sky_cell_solid_angle(std::size_t cell) {
  const std::size_t sector = cell % kSkySectors;
  return (sky_sector_begin(sector + 1) - sky_sector_begin(sector)) * (2.0 / kSkyBands);
}

Vec3d sky_irradiance(const Sky& sky, const Vec3d& normal) {
  const Vec3d local{vec::dot(normal, sky.east), vec::dot(normal, sky.north), vec::dot(normal, sky.up)};
  Vec3d sum = vec::scale(sky.sun_irradiance, std::max(0.0, vec::dot(normal, sky.sun)));
  for (std::size_t cell = 0; cell < sky.radiance.size(); ++cell) {
    double cosines = 0;
    for_each_point(cell, [&](const Vec3d& direction, double weight) {
      cosines += std::max(0.0, vec::dot(direction, local)) * weight;
    });
    sum = vec::add(sum, vec::scale(sky.radiance[cell], cosines * sky_cell_solid_angle(cell)));
  }
  return sum;
}

Vec3d sky_from_everywhere(const Sky& sky) {
  Vec3d sum = sky.sun_irradiance;
  for (std::size_t cell = 0; cell < sky.radiance.size(); ++cell)
    sum = vec::add(sum, vec::scale(sky.radiance[cell], sky_cell_solid_angle(cell)));
  return sum;
}

Vec3d sun_radiance(const Sky& sky) {
  const double tangent = std::tan(kSunRadiusDegrees * (std::numbers::pi / 180));
  return vec::scale(sky.sun_irradiance, 1 / (std::numbers::pi * tangent * tangent));
}

double greatest_sky_radiance(const Sky& sky) {
  double greatest = vec::largest(sky.sun_irradiance) / std::numbers::pi;
  for (const Vec3d& radiance : sky.radiance) greatest = std::max(greatest, vec::largest(radiance));
  return greatest;
}

}  // namespace torolux
