// SPDX-License-Identifier: MIT
// A table enters, programs for gnuplot and its pictures leave.
#include "host_tools/study/plots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <system_error>

#include "emulator/errors.hpp"
#include "host_tools/study/child.hpp"
#include "host_tools/study/figures.hpp"

namespace torolux::study {
namespace {

constexpr const char* kHead = R"(set encoding utf8
set grid
set xrange [*:*] noextend
set offsets graph 0.03, graph 0.03, 0, 0
)";

/// In single quotes, where gnuplot takes all characters as they are.
std::string text(const std::string& words) {
  std::string result = "'";
  for (const char c : words) result += c == '\'' ? std::string("''") : std::string(1, c >= 0 && c < ' ' ? ' ' : c);
  return result + "'";
}

struct Dot {
  double x;
  Json y, ideal;
};

struct Series {
  std::string name;
  std::vector<Dot> dots;
};

/// "machine.torus.flit_bytes" -> "flit_bytes".
std::string last_part(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  return dot == std::string::npos || !name.starts_with("machine.") ? name : name.substr(dot + 1);
}

/// Which curve a row belongs to: one for each value of the report's `by` and of all else besides x of which there is
/// more than one.
std::string series_of(const Plan& plan, const Table& table, const std::vector<Json>& row, const std::string& x) {
  const std::string& by = plan.report.by;
  std::string name;
  if (const std::size_t column = table.column(by); column < row.size()) name = cell_text(row[column]);
  for (std::size_t i = 0; i < table.varied; ++i) {
    const std::string& column = table.columns[i];
    if (column == x || column == by || (column == "pes" && x == "pe_count")) continue;
    const auto is_the_same = [&](const auto& other) { return other[i] == table.rows.front()[i]; };
    if (std::ranges::all_of(table.rows, is_the_same)) continue;
    if (const std::string cell = cell_text(row[i]); !cell.empty())
      name += (name.empty() ? "" : ", ") + (column == "varied" ? last_part(cell) : last_part(column) + " " + cell);
  }
  return name;
}

/// The places of x: numbers as they are; else one after the other, in the plan's order.
struct Places {
  bool numbers = true;
  std::vector<std::string> names;

  double of(const Json& value) const {
    if (numbers) return value.get<double>();
    return static_cast<double>(std::ranges::find(names, cell_text(value)) - names.begin());
  }
};

Places places_of(const Table& table, std::size_t column) {
  Places places;
  for (const auto& row : table.rows) {
    if (row[column].is_null()) continue;
    places.numbers = places.numbers && row[column].is_number();
    const std::string name = cell_text(row[column]);
    if (std::ranges::find(places.names, name) == places.names.end()) places.names.push_back(name);
  }
  return places;
}

std::vector<Series> series_in(const Plan& plan, const Table& table, const std::string& x, const std::string& y,
                              const Places& places) {
  std::vector<Series> all;
  const std::size_t at_x = table.column(x);
  const std::size_t at_y = table.column(y);
  const std::size_t efficiency = table.column("efficiency");
  const bool ideal = y == "speed_up" && x == "pe_count" && efficiency < table.columns.size();
  for (const auto& row : table.rows) {
    if (!row[at_y].is_number() || row[at_x].is_null()) continue;
    const std::string name = series_of(plan, table, row, x);
    auto series = std::ranges::find(all, name, &Series::name);
    if (series == all.end()) series = all.insert(all.end(), {name, {}});
    Dot dot{places.of(row[at_x]), row[at_y], Json()};
    if (ideal && row[efficiency].is_number() && row[efficiency].get<double>() > 0)
      dot.ideal = row[at_y].get<double>() / row[efficiency].get<double>();
    series->dots.push_back(std::move(dot));
  }
  for (Series& series : all) std::ranges::stable_sort(series.dots, {}, &Dot::x);
  return all;
}

bool powers_of_two(const std::vector<Series>& all) {
  int exponent = 0;
  return std::ranges::all_of(all, [&](const Series& series) {
    return std::ranges::all_of(series.dots, [&](const Dot& dot) { return std::frexp(dot.x, &exponent) == 0.5; });
  });
}

/// Long names go below the curves, in two columns, and make the page longer; beside them they would leave no room.
std::string page_text(const std::vector<Series>& all) {
  constexpr std::size_t kLongName = 18;  // characters: a quarter of the page
  const bool below = std::ranges::any_of(all, [](const Series& series) { return series.name.size() > kLongName; });
  const std::size_t height = 600 + (below ? 18 * ((all.size() + 2) / 2) : 0);
  return "set terminal svg size 900," + std::to_string(height) + " font \"sans,14\" background \"white\"\n" +
         (below ? "set key below left Left reverse maxcols 2 noenhanced\n" : "set key outside right noenhanced\n");
}

/// Eight colours; then the same with other dots and dashes.
std::string line_text(std::size_t series) {
  constexpr std::array<int, 4> kDots = {7, 5, 9, 13};  // discs, squares, triangles, diamonds
  const std::size_t round = series / 8;
  return "linewidth 2 pointtype " + std::to_string(kDots[round % kDots.size()]) + " pointsize 0.6 dashtype " +
         std::to_string(round % 5 + 1) + " ";
}

/// A logarithm needs numbers above 0.
template <class Of>
bool all_above_0(const std::vector<Series>& all, Of of) {
  return std::ranges::all_of(all, [&](const Series& series) {
    return std::ranges::all_of(series.dots, [&](const Dot& dot) { return of(dot) > 0; });
  });
}

std::string axes_text(const Plan& plan, const Table& table, const std::string& x, const std::string& y,
                      const Places& places, const std::vector<Series>& all) {
  std::string script = page_text(all) + kHead;
  const auto missing = std::ranges::count(table.there, false);
  std::string title = plan.report.title;
  if (missing > 0)
    title += (title.empty() ? "" : " ") +
             ("(" + std::to_string(missing) + " of " + std::to_string(table.there.size()) + " runs missing)");
  if (!title.empty()) script += "set title " + text(title) + " noenhanced\n";
  script += "set xlabel " + text(x == "pe_count" ? "PEs" : x) + " noenhanced\n";
  script += "set ylabel " + text(y) + " noenhanced\n";
  const bool log_x = plan.report.log_x && all_above_0(all, [](const Dot& dot) { return dot.x; });
  if (!places.numbers) {
    script += "set xtics noenhanced (";
    for (std::size_t i = 0; i < places.names.size(); ++i)
      script += (i == 0 ? "" : ", ") + text(places.names[i]) + " " + std::to_string(i);
    script += ")\n";
  } else if (log_x) {
    script += powers_of_two(all) ? "set logscale x 2\n" : "set logscale x\n";
  }
  // So the ideal is a straight line.
  const bool both = log_x && y.starts_with("speed_up");
  const bool log_y =
      (plan.report.log_y || both) && all_above_0(all, [](const Dot& dot) { return dot.y.get<double>(); });
  return script + (log_y ? "set logscale y\n" : "set yrange [0:*]\n");
}

}  // namespace

Axes axes_of(const Plan& plan) {
  Axes axes{plan.report.x, plan.report.y};
  const std::vector<std::string> names = varied_names(plan);
  if (axes.x.empty()) {
    if (!plan.vary_one.empty())
      axes.x = "value";
    else if (std::ranges::find(names, "pes") != names.end() && plan.command != "network")
      axes.x = "pe_count";
    else if (!names.empty())
      axes.x = names.front();
  }
  if (axes.y.empty() && plan.command != "network")
    axes.y = {"speed_up", "efficiency", "balance", "mean_hops", "memory"};
  return axes;
}

std::string plot_script(const Plan& plan, const Table& table, const std::string& x, const std::string& y) {
  if (table.column(x) >= table.columns.size() || table.column(y) >= table.columns.size()) return "";
  const Places places = places_of(table, table.column(x));
  const std::vector<Series> all = series_in(plan, table, x, y, places);
  if (all.empty()) return "";
  std::string script = axes_text(plan, table, x, y, places, all);
  std::string curves;
  const auto add = [&](const std::string& data, const std::string& how) {
    curves += (curves.empty() ? "plot " : ", \\\n     ") + data + how;
  };
  std::map<double, std::string> ideal;  // by x: a series alone may have few points
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string data = "$series" + std::to_string(i);
    script += data + " << END\n";
    for (const Dot& dot : all[i].dots) {
      script += cell_text(dot.x) + " " + cell_text(dot.y) + "\n";
      if (!dot.ideal.is_null()) ideal.emplace(dot.x, cell_text(dot.ideal));
    }
    script += "END\n";
    add(data, " using 1:2 with linespoints " + line_text(i) +
                  (all[i].name.empty() ? "notitle" : "title " + text(all[i].name) + " noenhanced"));
  }
  if (!ideal.empty()) {
    script += "$ideal << END\n";
    for (const auto& [at, value] : ideal) script += cell_text(at) + " " + value + "\n";
    script += "END\n";
    add("$ideal", " using 1:2 with lines dashtype 2 linecolor rgb 'gray50' title 'ideal'");
  }
  return script + curves + "\n";
}

std::string draw(const std::string& script) {
  try {
    const Ended ended = Child("gnuplot", {"-"}, script).wait();
    if (ended.exit_code != 0 || ended.output.empty())
      throw InputError("gnuplot could not draw a curve: " + ended.errors);
    return ended.output;
  } catch (const std::system_error& error) {
    throw InputError(std::string(error.what()) + "; curves are drawn by gnuplot: apt-get install gnuplot-nox");
  }
}

std::string plot_file(const std::string& y) {
  std::string name = y;
  for (char& c : name) {
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'))) c = '_';
  }
  return name + ".svg";
}

}  // namespace torolux::study
