// SPDX-License-Identifier: MIT
// Products of lists, zipped lists, and values alone.
#include "host_tools/study/points.hpp"

#include <algorithm>

namespace torolux::study {
namespace {

using Options = std::vector<PlanOption>;

void set(Options& options, const PlanOption& option) {
  const auto found = std::ranges::find(options, option.name, &PlanOption::name);
  if (found == options.end())
    options.push_back(option);
  else
    *found = option;
}

/// Axes that go together, as one.
struct Together {
  std::vector<const Axis*> axes;

  std::size_t size() const { return axes.front()->values.size(); }
};

std::vector<Together> groups_of(const Plan& plan) {
  std::vector<Together> groups;
  for (const Axis& axis : plan.vary) {
    const auto zipped = std::ranges::find_if(
        plan.zip, [&](const auto& names) { return std::ranges::find(names, axis.name) != names.end(); });
    const auto in_group = [&](const Together& group) {
      return zipped != plan.zip.end() && std::ranges::find(*zipped, group.axes.front()->name) != zipped->end();
    };
    const auto group = std::ranges::find_if(groups, in_group);
    if (group == groups.end())
      groups.push_back({{&axis}});
    else
      group->axes.push_back(&axis);
  }
  return groups;
}

/// Counts through all combinations, the last group fastest. False after the last one.
bool next(std::vector<std::size_t>& at, const std::vector<Together>& groups) {
  for (std::size_t i = at.size(); i-- > 0;) {
    if (++at[i] < groups[i].size()) return true;
    at[i] = 0;
  }
  return false;
}

void add_points(const Plan& plan, const Options& options, const Place& place, std::vector<Point>& points) {
  points.push_back({options, "", "", place});
  for (const Axis& axis : plan.vary_one) {
    for (const PlanOption& value : axis.values) {
      Point point{options, axis.name, value.value, value.place};
      set(point.options, value);
      points.push_back(std::move(point));
    }
  }
}

}  // namespace

std::string Point::value(const std::string& name) const {
  const auto found = std::ranges::find(options, name, &PlanOption::name);
  return found == options.end() ? "" : found->value;
}

std::vector<Point> points_of(const Plan& plan) {
  const std::vector<Together> groups = groups_of(plan);
  const std::vector<Options> runs = plan.runs.empty() ? std::vector<Options>(1) : plan.runs;
  std::vector<Point> points;
  for (const Options& run : runs) {
    std::vector<std::size_t> at(groups.size());
    do {
      Options options = plan.base;
      Place place{plan.file.string(), plan.vary_line};
      for (const PlanOption& option : run) {
        set(options, option);
        place = option.place;
      }
      for (std::size_t i = 0; i < groups.size(); ++i) {
        for (const Axis* axis : groups[i].axes) {
          set(options, axis->values[at[i]]);
          place = axis->values[at[i]].place;
        }
      }
      add_points(plan, options, place, points);
      if (points.size() > kMostPoints)
        refuse(place, "the plan asks for more than " + std::to_string(kMostPoints) + " runs");
    } while (next(at, groups));
  }
  return points;
}

std::vector<std::string> varied_names(const Plan& plan) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& name) {
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const auto& run : plan.runs)
    for (const PlanOption& option : run) add(option.name);
  for (const Axis& axis : plan.vary) add(axis.name);
  return names;
}

std::string label_of(const Point& point, const std::vector<std::string>& varied) {
  std::string label;
  const auto add = [&](const std::string& name, const std::string& value) {
    if (!value.empty()) label += (label.empty() ? "" : ", ") + name + "=" + value;
  };
  for (const std::string& name : varied) {
    if (name != point.one) add(name, point.value(name));
  }
  add(point.one, point.one_value);
  return label.empty() ? "base" : label;
}

}  // namespace torolux::study
