// SPDX-License-Identifier: MIT
// Proves: the statistics hold every key that is promised, with the run's own figures, and only wall_seconds and host
// depend on the computer.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "host_tools/report/csv.hpp"
#include "tests/unit/host_tools/report/made_up_run.hpp"

namespace torolux {
namespace {

using nlohmann::json;
using testing_support::made_up_figures;
using testing_support::made_up_run;

TEST(Stats, HoldThePromisedKeys) {
  const json stats = json::parse(stats_json(made_up_run(), made_up_figures()));
  EXPECT_EQ(stats["virtual_cycles"]["load"], 1'000'000);
  EXPECT_EQ(stats["virtual_cycles"]["radiosity"], 23'456'789);
  EXPECT_EQ(stats["virtual_cycles"]["ray_tracing"], 3'000'500);
  ASSERT_EQ(stats["pes"].size(), 2U);
  EXPECT_EQ(stats["pes"][1]["busy_cycles"], 500);
  EXPECT_EQ(stats["pes"][0]["idle_cycles"], 250);
  EXPECT_EQ(stats["pes"][1]["instructions"], 2000);
  EXPECT_EQ(stats["pes"][1]["record_slots_high_water"], 44);
  EXPECT_EQ(stats["packets"]["sent"], 1000);
  EXPECT_EQ(stats["packets"]["delivered"], 1000);
  EXPECT_EQ(stats["records"]["diverted"], 11);
  EXPECT_EQ(stats["hops"]["mean"], 2.5);
  EXPECT_EQ(stats["credits"]["total"], 512);
  EXPECT_EQ(stats["credits"]["home"], 512);
  for (const char* key : {"emitted", "absorbed", "absorbed_specular", "unshot", "escaped", "cut_off", "back_side"})
    EXPECT_EQ(stats["energy"][key].size(), 3U) << key;
  EXPECT_EQ(stats["energy"]["back_side"][2], 1.5);
  EXPECT_EQ(stats["shots"], 42);
  EXPECT_EQ(stats["rays"], 307'200);
  EXPECT_EQ(stats["wall_seconds"], 83.21);
  EXPECT_EQ(stats["engine"], "qemu");
  EXPECT_EQ(stats["trace_hash"], "0x000000000000abcd");
  EXPECT_EQ(stats["phases"]["traverse"], 33);
  EXPECT_EQ(stats["settings"]["patches"], "auto");
  EXPECT_EQ(stats["settings"]["elements"], 0.5);
  EXPECT_EQ(stats["settings"]["subspaces"], json({8, 4, 8}));
}

TEST(Stats, DependOnTheComputerInTwoPlacesOnly) {
  RunDescription run = made_up_run();
  RenderFigures figures = made_up_figures();
  json before = json::parse(stats_json(run, figures));
  run.machine.threads = 1;
  figures.wall_seconds = 1;
  figures.machine.scheduler_seconds = 2;
  figures.machine.program_seconds = 1;
  figures.machine.engine_seconds = 3;
  json after = json::parse(stats_json(run, figures));
  EXPECT_NE(before, after);
  for (json* stats : {&before, &after}) {
    stats->erase("wall_seconds");
    stats->erase("host");
  }
  EXPECT_EQ(before, after);
}

TEST(Stats, AreValidForARunWithoutPackets) {
  const json stats = json::parse(stats_json(RunDescription{}, RenderFigures{}));
  EXPECT_EQ(stats["hops"]["mean"], 0);
  EXPECT_TRUE(stats["pes"].is_array());
}

TEST(Stats, NameOfASceneThatIsNotUtf8) {
  RunDescription run;
  run.scene = "r\xFFoom";
  EXPECT_TRUE(json::accept(stats_json(run, RenderFigures{})));
}

/// Every path of a document: names with dots between them, [] for an entry of a list.
void collect_paths(const json& value, const std::string& path, std::set<std::string>& paths) {
  if (value.is_object()) {
    for (const auto& [name, inner] : value.items())
      collect_paths(inner, path.empty() ? name : path + "." + name, paths);
  } else if (value.is_array()) {
    for (const json& inner : value) collect_paths(inner, path + "[]", paths);
  } else {
    paths.insert(path);
  }
}

/// Patterns of docs/statistics.md: what stands in backticks in the first column of the table of keys.
std::vector<std::string> documented_keys() {
  std::ifstream page(std::string(TOROLUX_SOURCE_DIR) + "/docs/statistics.md");
  std::vector<std::string> keys;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("## ")) inside = line == "## Keys";
    if (!inside || !line.starts_with("| `")) continue;
    const std::string cell = line.substr(0, line.find('|', 1));
    for (std::size_t at = cell.find('`'); at != std::string::npos; at = cell.find('`', at + 1)) {
      const std::size_t end = cell.find('`', at + 1);
      keys.push_back(cell.substr(at + 1, end - at - 1));
      at = end;
    }
  }
  return keys;
}

/// `*` stands for one name.
bool matches(const std::string& pattern, const std::string& path) {
  std::string expression;
  for (const char c : pattern) {
    if (c == '*') {
      expression += "[^.]+";
    } else {
      expression += std::string(".[]").find(c) != std::string::npos ? std::string("\\") + c : std::string(1, c);
    }
  }
  return std::regex_match(path, std::regex(expression));
}

TEST(Stats, AreThoseOfThePage) {
  RunDescription run = made_up_run();
  run.quality.layers = 1U << 1U;
  RenderFigures figures = testing_support::whole_figures();
  figures.layers_sha256 = {"abc"};
  figures.path = {{5, "abc"}};
  json stats = json::parse(stats_json(run, figures));
  stats["settings"] = 0;
  stats["command_line"] = 0;
  std::set<std::string> paths;
  collect_paths(stats, "", paths);
  const std::vector<std::string> keys = documented_keys();
  ASSERT_GT(keys.size(), 50U);
  std::set<std::string> met;
  for (const std::string& path : paths) {
    const std::string inner = path.starts_with("stages[].") ? path.substr(9) : path;
    bool found = false;
    for (const std::string& key : keys) {
      if (!matches(key, path) && !matches(key, inner)) continue;
      found = true;
      met.insert(key);
    }
    EXPECT_TRUE(found) << path << " is not in docs/statistics.md";
  }
  for (const std::string& key : keys) EXPECT_TRUE(met.contains(key)) << key << " is on the page alone";
}

TEST(StatsTables, HaveTheirHeadersColumns) {
  RenderFigures figures = testing_support::whole_figures();
  figures.radiosity_visits[3] = 7;
  const std::vector<CsvTable> tables = stats_tables(figures);
  EXPECT_EQ(tables.size(), 10U);
  EXPECT_EQ(tables.back().text(), "stage,subspaces,segments\nradiosity,3,7\n");
  for (const CsvTable& table : tables) {
    const auto commas = std::count(table.header.begin(), table.header.end(), ',');
    EXPECT_FALSE(table.rows.empty()) << table.name;
    for (const std::string& row : table.rows) EXPECT_EQ(std::count(row.begin(), row.end(), ','), commas) << row;
    for (const char c : table.header) EXPECT_TRUE(c == ',' || c == '_' || (c >= 'a' && c <= 'z')) << table.header;
  }
}

TEST(ClosingError, IsTheWorstChannelRelativeToItsOwnEmission) {
  EXPECT_NEAR(closing_error(made_up_figures().energy), 1e-5, 1e-12) << "0.001 of 100 W of red";
  EXPECT_EQ(closing_error(EnergyBalance{}), 0);
}

}  // namespace
}  // namespace torolux
