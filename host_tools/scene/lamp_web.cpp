// SPDX-License-Identifier: MIT
// Over a step of the turn the integral is that of the mean of both its ends; over a step of gamma, intensity is a
// straight line times the sine of gamma, which has a closed integral.
#include "host_tools/scene/lamp_web.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace torolux {
namespace {

constexpr double kRadian = std::numbers::pi / 180;

/// The lower end of the step that holds a value, and how far it is on the way to the upper one.
struct Step {
  std::size_t lower;
  double part;
};
Step step_of(const std::vector<double>& angles, double at) {
  const auto upper = std::ranges::upper_bound(angles, at);
  const auto last = static_cast<std::ptrdiff_t>(angles.size()) - 2;
  const auto lower = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(upper - angles.begin() - 1, 0, last));
  return {lower, std::clamp((at - angles[lower]) / (angles[lower + 1] - angles[lower]), 0.0, 1.0)};
}

/// Of a straight line from a to b over the angles from `begin` to `end` [radian], times their sine.
double integral_with_sine(double begin, double end, double a, double b) {
  const double slope = (b - a) / (end - begin);
  return a * std::cos(begin) - b * std::cos(end) + slope * (std::sin(end) - std::sin(begin));
}

}  // namespace

double intensity_of(const LampWeb& web, double gamma, double turn) {
  if (gamma < web.gamma.front() || gamma > web.gamma.back()) return 0;
  const Step along = step_of(web.gamma, gamma);
  const auto at_turn = [&](std::size_t number) {
    const double* of_turn = &web.intensity[number * web.gamma.size()];
    return std::lerp(of_turn[along.lower], of_turn[along.lower + 1], along.part);
  };
  if (web.turn.size() == 1) return at_turn(0);
  const Step around = step_of(web.turn, turn - 360 * std::floor(turn / 360));
  return std::lerp(at_turn(around.lower), at_turn(around.lower + 1), around.part);
}

std::array<double, 2> flux_of(const LampWeb& web) {
  const std::size_t steps = web.turn.size() == 1 ? 1 : web.turn.size() - 1;
  std::array<double, 2> flux{0, 0};
  for (std::size_t t = 0; t < steps; ++t) {
    const double width = (steps == 1 ? 360 : web.turn[t + 1] - web.turn[t]) * kRadian;
    const std::size_t next = web.turn.size() == 1 ? 0 : t + 1;
    for (std::size_t g = 0; g + 1 < web.gamma.size(); ++g) {
      const auto mean = [&](std::size_t i) {
        return (web.intensity[t * web.gamma.size() + i] + web.intensity[next * web.gamma.size() + i]) / 2;
      };
      const double part =
          width * integral_with_sine(web.gamma[g] * kRadian, web.gamma[g + 1] * kRadian, mean(g), mean(g + 1));
      flux[web.gamma[g] < 90 ? 0 : 1] += std::max(part, 0.0);
    }
  }
  return flux;
}

}  // namespace torolux
