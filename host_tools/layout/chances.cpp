// SPDX-License-Identifier: MIT
// Sums of weights, rounded down; whatever has a weight keeps a chance.
#include "host_tools/layout/chances.hpp"

#include <algorithm>
#include <cmath>

namespace torolux {

std::vector<std::uint32_t> chances(const std::vector<double>& weights) {
  double sum = 0;
  std::size_t last = 0;
  std::uint64_t to_come = 0;  // of those with a weight, each of which keeps a chance
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i];
    if (!(weights[i] > 0)) continue;
    last = i;
    ++to_come;
  }
  constexpr auto all = std::uint64_t{1} << 32U;
  std::vector<std::uint32_t> chosen_to;
  double until = 0;
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    until += weights[i];
    auto next = static_cast<std::uint64_t>(std::ldexp(std::min(until / sum, 1.0), 32));
    if (weights[i] > 0) {
      next = std::max(next, before + 1);  // or its light would never come
      --to_come;
    }
    next = i >= last ? all : std::min(next, all - to_come);
    before = std::max(before, next);
    chosen_to.push_back(static_cast<std::uint32_t>(before == 0 ? 0 : before - 1));
  }
  return chosen_to;
}

}  // namespace torolux
