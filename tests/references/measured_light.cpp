// SPDX-License-Identifier: MIT
// Interpolates between the web's four angles around a direction. What all directions have is added up in steps of a
// tenth of a degree by five.
#include "tests/references/measured_light.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace torolux::references {
namespace {

constexpr double kDegree = 180 / std::numbers::pi;

}  // namespace

MeasuredLight::MeasuredLight(const LampWeb& web, const SceneLamp& lamp)
    : web_(web), x_(vec(lamp.x)), y_(vec(lamp.y)), nadir_(vec(lamp.nadir)) {
  double sum = 0;
  for (int g = 0; g < 1800; ++g)
    for (int t = 0; t < 72; ++t)
      sum += in_web((g + 0.5) / 10, t * 5 + 2.5) * std::sin((g + 0.5) / 10 / kDegree) * (0.1 / kDegree) * (5 / kDegree);
  all_ = sum / std::numbers::pi;
}

double MeasuredLight::intensity(const Vec& out) const {
  const double gamma = std::acos(std::clamp(out.dot(nadir_), -1.0, 1.0)) * kDegree;
  double turn = std::atan2(out.dot(y_), out.dot(x_)) * kDegree;
  if (turn < 0) turn += 360;
  return in_web(gamma, turn) / all_;
}

double MeasuredLight::in_web(double gamma, double turn) const {
  const auto& gammas = web_.gamma;
  if (gamma < gammas.front() || gamma > gammas.back()) return 0;
  std::size_t g = 0;
  while (g + 2 < gammas.size() && gammas[g + 1] < gamma) ++g;
  const double along = (gamma - gammas[g]) / (gammas[g + 1] - gammas[g]);
  const auto at = [&](std::size_t t) {
    return web_.intensity[t * gammas.size() + g] * (1 - along) + web_.intensity[t * gammas.size() + g + 1] * along;
  };
  if (web_.turn.size() == 1) return at(0);
  std::size_t t = 0;
  while (t + 2 < web_.turn.size() && web_.turn[t + 1] < turn) ++t;
  const double around = (turn - web_.turn[t]) / (web_.turn[t + 1] - web_.turn[t]);
  return at(t) * (1 - around) + at(t + 1) * around;
}

}  // namespace torolux::references
