// SPDX-License-Identifier: MIT
// Points and results enter, rows leave.
#include "host_tools/study/table.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/report/text.hpp"
#include "host_tools/scene/statements.hpp"
#include "host_tools/study/figures.hpp"

namespace torolux::study {
namespace {

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

/// Same in everything that varies but for what the plan's baseline names.
bool is_baseline_of(const Plan& plan, const Point& candidate, const Point& point,
                    const std::vector<std::string>& varied) {
  if (!candidate.one.empty()) return false;
  return std::ranges::all_of(varied, [&](const std::string& name) {
    const auto wanted = plan.report.baseline.find(name);
    return candidate.value(name) == (wanted == plan.report.baseline.end() ? point.value(name) : wanted->second);
  });
}

/// By point: the position of the one to compare with; points.size(): there is none. Without a baseline in the plan it
/// is the first point, or, where values vary alone, the base that they vary from.
std::vector<std::size_t> baselines_of(const Plan& plan, const std::vector<Point>& points,
                                      const std::vector<std::string>& varied) {
  std::vector<std::size_t> baselines;
  for (const Point& point : points) {
    std::size_t found = 0;
    if (!plan.report.baseline.empty() || !plan.vary_one.empty()) {
      const auto it = std::ranges::find_if(
          points, [&](const Point& candidate) { return is_baseline_of(plan, candidate, point, varied); });
      found = static_cast<std::size_t>(it - points.begin());
    }
    baselines.push_back(found);
  }
  return baselines;
}

const Json* result_at(const std::map<std::string, Json>& results, const std::string& key) {
  const auto found = results.find(key);
  return found == results.end() ? nullptr : &found->second;
}

/// Numbers as such, so that plots and tables can tell.
Json plan_value(const std::string& text) {
  const Json parsed = Json::parse(text, nullptr, false);
  return parsed.is_number() ? parsed : text.empty() ? Json() : Json(text);
}

std::string quoted(const std::string& cell) {
  if (cell.find_first_of(",\"\n\r") == std::string::npos) return cell;
  std::string text = "\"";
  for (const char c : cell) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

std::string for_people(const Json& value) {
  if (value.is_null()) return "";
  if (!value.is_number()) return cell_text(value);
  const double number = value.get<double>();
  if (value.is_number_integer() && std::abs(number) < 1e6) return cell_text(value);
  return significant(number, 4);
}

}  // namespace

void check_baseline(const Plan& plan, const std::vector<Point>& points) {
  if (plan.report.baseline.empty()) return;
  const auto line = plan.report.lines.find("baseline");
  const Place place{plan.file.string(), line == plan.report.lines.end() ? 0 : line->second};
  for (const auto& [name, value] : plan.report.baseline) {
    const std::string& key = name;
    const std::string& wanted = value;
    if (std::ranges::none_of(points, [&](const Point& point) { return point.value(key) == wanted; }))
      refuse(place, "[report]: 'baseline' names no run of the plan: none has " + key + " = " + in_quotes(wanted));
  }
  const std::vector<std::size_t> baselines = baselines_of(plan, points, varied_names(plan));
  if (std::ranges::any_of(baselines, [&](std::size_t baseline) { return baseline < points.size(); })) return;
  refuse(place,
         "[report]: 'baseline' names no run of the plan: of what varies, it takes values that stand in the lists");
}

std::size_t Table::column(const std::string& name) const {
  return static_cast<std::size_t>(std::ranges::find(columns, name) - columns.begin());
}

Table make_table(const Plan& plan, const std::vector<Point>& points, const std::vector<std::string>& keys,
                 const std::map<std::string, Json>& results, const std::vector<std::string>& y) {
  Table table;
  const std::vector<std::string> names = varied_names(plan);
  table.columns = names;
  if (!plan.vary_one.empty()) table.columns.insert(table.columns.end(), {"varied", "value"});
  table.varied = table.columns.size();
  std::vector<std::string> figures = y;
  if (plan.command == "render" || plan.command == "run") {
    for (const std::string& name : standard_names()) add_once(figures, name);
  } else {
    for (const std::string& key : keys) {
      const Json* result = result_at(results, key);
      if (result == nullptr) continue;
      for (const auto& [name, value] : result->items()) add_once(figures, name);
    }
  }
  table.columns.insert(table.columns.end(), figures.begin(), figures.end());
  const std::vector<std::size_t> baselines = baselines_of(plan, points, names);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<Json> row;
    row.reserve(table.columns.size());
    for (const std::string& name : names) row.push_back(plan_value(points[i].value(name)));
    if (!plan.vary_one.empty()) {
      row.push_back(points[i].one.empty() ? Json("base") : Json(points[i].one));
      row.push_back(plan_value(points[i].one_value));
    }
    const Json* result = result_at(results, keys[i]);
    const Json* baseline = baselines[i] < keys.size() ? result_at(results, keys[baselines[i]]) : nullptr;
    for (const std::string& name : figures) row.push_back(result != nullptr ? figure(*result, baseline, name) : Json());
    table.rows.push_back(std::move(row));
    table.there.push_back(result != nullptr);
  }
  return table;
}

std::string csv_of(const Table& table) {
  std::string text;
  for (const std::string& column : table.columns) text += (text.empty() ? "" : ",") + quoted(column);
  text += "\n";
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) text += (i == 0 ? "" : ",") + quoted(cell_text(row[i]));
    text += "\n";
  }
  return text;
}

std::string markdown_of(const Table& table, const std::vector<std::string>& y) {
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < table.varied; ++i) shown.push_back(i);
  for (const std::string& name : y) shown.push_back(table.column(name));
  std::string text = "|";
  for (const std::size_t column : shown) text += " " + table.columns[column] + " |";
  text += "\n|";
  for (const std::size_t column : shown) text += column < table.varied ? " --- |" : " ---: |";
  text += "\n";
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    text += "|";
    for (const std::size_t column : shown) {
      const Json& value = table.rows[row][column];
      const bool varied = column < table.varied;
      text += " " + (varied ? cell_text(value) : table.there[row] ? for_people(value) : "missing") + " |";
    }
    text += "\n";
  }
  return text;
}

}  // namespace torolux::study
