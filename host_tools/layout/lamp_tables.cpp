// SPDX-License-Identifier: MIT
// Bands are narrow where much of the light goes and where it changes: a third of them by angle, a third by flux, a
// third by how much the intensity rises and falls. Intensities are scaled so that each side's sum is the web's own.
#include "host_tools/layout/lamp_tables.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "host_tools/layout/chances.hpp"
#include "host_tools/mesh/normalise.hpp"
#include "host_tools/scene/lamp_web.hpp"

namespace torolux {
namespace {

constexpr double kRadian = std::numbers::pi / 180;

/// One side of a web: theta is the angle to its normal, 0..90 degrees.
class WebSide {
 public:
  WebSide(const LampWeb& web, bool back) : web_(web), back_(back) {}

  double intensity(double theta, double turn) const { return intensity_of(web_, back_ ? 180 - theta : theta, turn); }

  /// Ascending, from 0 to 90: the web's own, and between them no more than half a degree apart.
  std::vector<double> thetas() const {
    std::vector<double> all;
    for (int i = 0; i <= 180; ++i) all.push_back(i * 0.5);
    for (const double gamma : web_.gamma)
      if (const double theta = back_ ? 180 - gamma : gamma; theta > 0 && theta < 90) all.push_back(theta);
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end(), [](double a, double b) { return b - a < 1e-6; }), all.end());
    return all;
  }

  /// As fine as the web's turns, where the machine has room for that.
  std::uint32_t sectors() const {
    if (web_.turn.size() == 1) return 1;
    double finest = 360;
    for (std::size_t i = 1; i < web_.turn.size(); ++i) finest = std::min(finest, web_.turn[i] - web_.turn[i - 1]);
    const double wanted = std::clamp(360 / finest, 16.0, double{protocol::kMostLampSectors});
    return (static_cast<std::uint32_t>(std::ceil(wanted - 1e-6)) + 3U) / 4U * 4U;
  }

  /// Borders of the bands, ascending.
  std::vector<double> borders() const {
    const std::vector<double> theta = thetas();
    std::vector<double> flux(theta.size(), 0);
    std::vector<double> change(theta.size(), 0);
    for (std::size_t i = 1; i < theta.size(); ++i) {
      double brightest = 0;
      double most = 0;
      for (const double turn : web_.turn) {
        const double before = intensity(theta[i - 1], turn);
        const double here = intensity(theta[i], turn);
        brightest = std::max(brightest, (before + here) / 2);
        most = std::max(most, std::abs(here - before));
      }
      const double area = std::cos(theta[i - 1] * kRadian) - std::cos(theta[i] * kRadian);
      flux[i] = flux[i - 1] + brightest * area;
      change[i] = change[i - 1] + most;
    }
    const auto share = [](const std::vector<double>& sums, std::size_t i) {
      return sums.back() > 0 ? sums[i] / sums.back() : 0;
    };
    std::vector<double> bands{0};
    const double all = 1 + share(flux, flux.size() - 1) + share(change, change.size() - 1);
    const auto upto = [&](std::size_t i) { return (theta[i] / 90 + share(flux, i) + share(change, i)) / all; };
    for (std::size_t i = 1; i < theta.size() && bands.size() < protocol::kMostLampBands; ++i) {
      const double begin = upto(i - 1);
      const double end = upto(i);
      while (bands.size() < protocol::kMostLampBands) {
        const double next = static_cast<double>(bands.size()) / protocol::kMostLampBands;
        if (next >= end) break;
        bands.push_back(std::lerp(theta[i - 1], theta[i], (next - begin) / (end - begin)));
      }
    }
    bands.push_back(90);
    return bands;
  }

 private:
  const LampWeb& web_;
  bool back_;
};

class TableWriter {
 public:
  explicit TableWriter(LampTables& tables) : tables_(tables) {}

  /// share: of the lamp's flux.
  protocol::LampSide write(const WebSide& web, double share) {
    protocol::LampSide side{};
    if (!(share > 0)) return side;
    const std::vector<float> heights = heights_of(web);
    side.bands = static_cast<std::uint32_t>(heights.size() - 1);
    side.sectors = web.sectors();
    std::vector<double> values;
    for (const float height : heights) {
      const double theta = std::acos(std::min(double{height}, 1.0)) / kRadian;
      for (std::uint32_t s = 0; s < side.sectors; ++s) values.push_back(web.intensity(theta, 360.0 * s / side.sectors));
    }
    std::vector<double> cells = fluxes_of(heights, values, side.sectors);
    double sum = 0;
    for (const double cell : cells) sum += cell;
    if (!(sum > 0)) return {};
    const auto put = [](auto& to, const auto& from) {
      const auto first = static_cast<std::uint32_t>(to.size());
      to.insert(to.end(), from.begin(), from.end());
      return first;
    };
    side.heights = put(tables_.values, heights);
    for (double& value : values) value *= std::numbers::pi * share / sum;
    side.values = put(tables_.values, std::vector<float>(values.begin(), values.end()));
    side.chances = put(tables_.chances, chances(cells));
    return side;
  }

 private:
  /// Falling from 1 to 0, none twice.
  static std::vector<float> heights_of(const WebSide& web) {
    std::vector<float> heights;
    for (const double theta : web.borders()) {
      const auto height = theta < 90 ? static_cast<float>(std::cos(theta * kRadian)) : 0.0F;
      if (heights.empty() || height < heights.back()) heights.push_back(height);
    }
    return heights;
  }

  /// Integral of what is bilinear over each cell.
  static std::vector<double> fluxes_of(const std::vector<float>& heights, const std::vector<double>& values,
                                       std::uint32_t sectors) {
    std::vector<double> cells;
    for (std::size_t band = 0; band + 1 < heights.size(); ++band) {
      const double area = (double{heights[band]} - double{heights[band + 1]}) * 2 * std::numbers::pi / sectors;
      for (std::uint32_t s = 0; s < sectors; ++s) {
        const std::size_t next = (s + 1) % sectors;
        const std::size_t upper = band * sectors;
        const std::size_t lower = upper + sectors;
        cells.push_back(area * (values[upper + s] + values[upper + next] + values[lower + s] + values[lower + next]) /
                        4);
      }
    }
    return cells;
  }

  LampTables& tables_;
};

}  // namespace

LampTables lamp_tables(const Scene& scene) {
  LampTables tables;
  TableWriter writer(tables);
  std::vector<std::optional<std::array<protocol::LampSide, 2>>> of_web(scene.webs.size());
  for (const SceneLamp& lamp : scene.lamps) {
    auto& sides = of_web[lamp.web];
    if (!sides) {
      const LampWeb& web = scene.webs[lamp.web];
      sides = {writer.write(WebSide(web, false), lamp.share[0]), writer.write(WebSide(web, true), lamp.share[1])};
    }
    tables.lamps.push_back({to_float(lamp.x), to_float(lamp.y), to_float(lamp.nadir), *sides});
  }
  return tables;
}

std::vector<double> brightest_seen(const Scene& scene) {
  const LampTables tables = lamp_tables(scene);
  std::vector<double> brightest;
  for (const protocol::Lamp& lamp : tables.lamps) {
    double most = 0;
    for (const protocol::LampSide& side : lamp.side) {
      for (std::uint32_t i = 0; side.bands > 0 && i < (side.bands + 1) * side.sectors; ++i) {
        // The intensity of a band's upper border is seen as slanted as its lower one is.
        const std::uint32_t below = std::min(i / side.sectors + 1, side.bands);
        const float slant = std::max(tables.values[side.heights + below], protocol::kLeastLampCosine);
        most = std::max(most, double{tables.values[side.values + i]} / double{slant});
      }
    }
    brightest.push_back(most);
  }
  return brightest;
}

}  // namespace torolux
