// SPDX-License-Identifier: MIT
// A plan enters; the runs that it asks for leave, in its order.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "host_tools/study/plan.hpp"

namespace torolux::study {

/// One run that the plan asks for.
struct Point {
  std::vector<PlanOption> options;  ///< base, [[run]] and varied ones; each name once
  std::string one, one_value;       ///< of [vary_one]: the option that differs and its value; empty at the base
  Place place;                      ///< what asked for it, for messages

  /// Its value of an option as the plan gives it; empty where it does not.
  std::string value(const std::string& name) const;
};

/// For each [[run]] (or none), each value of [vary] with each of the others, the first named slowest, zipped ones
/// together; and for each of those the base and then every value of [vary_one] alone. Throws InputError for more than
/// kMostPoints.
std::vector<Point> points_of(const Plan& plan);
inline constexpr std::size_t kMostPoints = 100'000;

/// Names of options that differ between points other than by [vary_one], in the plan's order: the columns of a table.
std::vector<std::string> varied_names(const Plan& plan);

/// As a person says it: "pes=2x2, machine.torus.flit_bytes=4"; the base is "base".
std::string label_of(const Point& point, const std::vector<std::string>& varied);

}  // namespace torolux::study
