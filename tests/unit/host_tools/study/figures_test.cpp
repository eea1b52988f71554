// SPDX-License-Identifier: MIT
// Proves: figures follow from statistics as documented; tables are the same for the same results, and say what misses.
#include "host_tools/study/figures.hpp"
#include "emulator/errors.hpp"

#include <gmock/gmock.h>

#include "host_tools/study/plots.hpp"
#include "host_tools/study/table.hpp"

namespace torolux::study {
namespace {

Json statistics(unsigned columns, std::uint64_t radiosity) {
  return {{"virtual_cycles", {{"load", 100}, {"radiosity", radiosity}, {"ray_tracing", 300}}},
          {"hops", {{"mean", 1.25}}},
          {"histograms", {{"bytes_by_hops", {1000, 60, 40}}}},
          {"settings", {{"pes", {columns, 2}}, {"pe_memory", 1048576}}},
          {"pes", {{{"busy_cycles", 10}, {"idle_cycles", 30}}, {{"busy_cycles", 20}, {"idle_cycles", 20}}}}};
}

TEST(Figures, FollowFromTheStatistics) {
  const Json first = statistics(1, 1600);
  const Json run = statistics(4, 400);
  const auto of = [&](const char* name) { return figure(run, &first, name); };
  EXPECT_EQ(of("pe_count"), 8);
  EXPECT_EQ(of("cycles"), 800);
  EXPECT_EQ(of("cycles.radiosity"), 400);
  EXPECT_EQ(of("virtual_cycles.radiosity"), 400);
  EXPECT_EQ(of("relative"), 0.4);
  EXPECT_EQ(of("speed_up"), 2.5);
  EXPECT_EQ(of("speed_up.radiosity"), 4.0);
  EXPECT_EQ(of("efficiency"), 2.5 / 4);
  EXPECT_EQ(of("efficiency.radiosity"), 1.0);
  EXPECT_EQ(of("balance"), 0.75);
  EXPECT_EQ(of("utilisation"), 30.0 / 80);
  EXPECT_EQ(of("mean_hops"), 1.25);
  EXPECT_EQ(of("adjacent_share"), 0.6) << "what stays in a PE does not count";
  EXPECT_EQ(of("memory"), 1048576);
  EXPECT_EQ(of("pes.1.busy_cycles"), 20);
  for (const char* name : {"nothing", "hops.least", "pes.2.busy_cycles", "pes.x", "cycles.paint"})
    EXPECT_TRUE(of(name).is_null()) << name;
  EXPECT_TRUE(figure(run, nullptr, "speed_up").is_null()) << "the baseline has not run";
}

TEST(Figures, OfACsvAreItsColumns) {
  const auto row = row_of_csv("offered,accepted,name\n0.1,12,a\n");
  ASSERT_TRUE(row);
  EXPECT_EQ(figure(*row, nullptr, "offered"), 0.1);
  EXPECT_EQ(figure(*row, nullptr, "accepted"), 12);
  EXPECT_FALSE(row_of_csv("offered\n"));
  EXPECT_FALSE(row_of_csv("offered\n0.1\n0.2\n")) << "several rates at once are several runs";
  EXPECT_FALSE(row_of_csv("a,b\n1\n"));
  EXPECT_FALSE(row_of_csv(""));
  EXPECT_FALSE(row_of_csv("\n\n"));
}

TEST(Results, OfAnotherRunAreRefusedWhateverTheyAre) {
  const std::string own = R"({"seed":1,"inputs":[],"automatic":["pes"]})";
  const auto of = [&own](const std::string& text) { return statistics_of(text, own, "a.json"); };
  EXPECT_TRUE(of(R"({"settings":{"seed":1,"scene":"x","inputs":[],"automatic":["pes"],"pes":4}})"));
  for (const char* text : {"", "7", "{", "\xff"}) EXPECT_FALSE(of(text)) << text;
  for (const char* settings :
       {R"({"seed":2,"inputs":[]})", "7", "[]", R"({"automatic":[7]})", R"({"automatic":3})", R"({"inputs":[7]})"})
    EXPECT_THROW(of(R"({"settings":)" + std::string(settings) + "}"), InputError) << settings;
  EXPECT_THROW(of("{}"), InputError);
}

TEST(Cells, AreExact) {
  EXPECT_EQ(cell_text(0.1), "0.1");
  EXPECT_EQ(cell_text(std::uint64_t{18446744073709551615U}), "18446744073709551615");
  EXPECT_EQ(cell_text(1.0 / 3), "0.3333333333333333");
  EXPECT_EQ(cell_text(nullptr), "");
}

/// Two kinds of allocation on one and two columns of PEs.
struct SmallStudy {
  Plan plan = parse_plan(
      "[base]\ncommand = 'render'\nscene = 'a'\n[vary]\npes = ['1x2', '2x2']\nallocation = ['block', 'skewed:zy']\n"
      "[report]\nbaseline = {pes = '1x2'}\n",
      "plan.toml");
  std::vector<Point> points = points_of(plan);
  std::vector<std::string> keys{"a", "b", "c", "d"};
  std::map<std::string, Json> results{
      {"a", statistics(1, 1600)}, {"b", statistics(1, 800)}, {"c", statistics(2, 400)}, {"d", statistics(2, 600)}};

  Table table() const { return make_table(plan, points, keys, results, {"speed_up"}); }
};

TEST(Tables, CompareWithTheBaselineThatIsOtherwiseTheSame) {
  const Table table = SmallStudy().table();
  const std::size_t column = table.column("speed_up");
  EXPECT_EQ(table.rows[2][column], 2000.0 / 800) << "2x2, block against 1x2, block";
  EXPECT_EQ(table.rows[3][column], 1200.0 / 1000) << "2x2, skewed against 1x2, skewed";
  EXPECT_THAT(csv_of(table), testing::StartsWith("pes,allocation,speed_up,pe_count,cycles,"));
  EXPECT_THAT(csv_of(table), testing::HasSubstr("\n2x2,skewed:zy,1.2,4,1000,100,600,300,"));
}

TEST(Tables, SayWhatIsMissing) {
  SmallStudy study;
  study.results.erase("c");
  const Table table = study.table();
  EXPECT_THAT(csv_of(table), testing::HasSubstr("\n2x2,block,,,"));
  EXPECT_THAT(markdown_of(table, {"speed_up"}), testing::HasSubstr("| 2x2 | block | missing |"));
  EXPECT_THAT(plot_script(study.plan, table, "pe_count", "speed_up"), testing::HasSubstr("(1 of 4 runs missing)"));
}

TEST(Plots, DrawACurveForEachSeriesAndTheSameBytesAlways) {
  const SmallStudy study;
  const std::string script = plot_script(study.plan, study.table(), "pe_count", "speed_up");
  EXPECT_THAT(script, testing::HasSubstr("$series0 << END\n2 1\n4 2.5\nEND\n"));
  EXPECT_THAT(script, testing::HasSubstr("title 'allocation skewed:zy' noenhanced"));
  EXPECT_THAT(script, testing::HasSubstr("$ideal << END\n2 1\n4 2\nEND\n"));
  const std::string svg = draw(script);
  EXPECT_THAT(svg, testing::HasSubstr("skewed:zy"));
  EXPECT_EQ(draw(script), svg);
  EXPECT_EQ(plot_script(study.plan, study.table(), "pe_count", "nothing"), "");
  EXPECT_EQ(plot_file("torus.hops/mean"), "torus_hops_mean.svg");
}

// The first series may have fewer points than others: one PE alone, with memory of its own, say.
TEST(Plots, TheIdealGoesThroughThePointsOfAllSeries) {
  SmallStudy study;
  study.results.erase("c");
  const std::string script = plot_script(study.plan, study.table(), "pe_count", "speed_up");
  EXPECT_THAT(script, testing::HasSubstr("$series0 << END\n2 1\nEND\n"));
  EXPECT_THAT(script, testing::HasSubstr("$ideal << END\n2 1\n4 2\nEND\n"));
}

/// A study of `network` with the results' latencies all 7.
std::string script_of(const std::string& vary, const std::string& report) {
  const Plan plan = parse_plan("[base]\ncommand = 'network'\n[vary]\n" + vary + "[report]\n" + report, "plan.toml");
  const std::vector<Point> points = points_of(plan);
  std::vector<std::string> keys;
  std::map<std::string, Json> results;
  for (std::size_t i = 0; i < points.size(); ++i) {
    keys.push_back(std::to_string(i));
    results[keys.back()] = {{"mean_latency", 7}};
  }
  const Table table = make_table(plan, points, keys, results, {"mean_latency"});
  return plot_script(plan, table, axes_of(plan).x, "mean_latency");
}

// Ten curves in eight colours: the ninth looks like no other.
TEST(Plots, NoTwoCurvesLookTheSame) {
  const std::string script = script_of("rate = [0.1, 0.2]\nseed = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]\n", "x = 'rate'\n");
  std::size_t seen = 0;
  for (std::size_t at = 0; (at = script.find(" pointtype 7 ", at)) != std::string::npos; ++at) ++seen;
  EXPECT_EQ(seen, 8U);
  EXPECT_THAT(script, testing::HasSubstr("pointtype 5 pointsize 0.6 dashtype 2 title 'seed 9'"));
}

TEST(Plots, NameOnlyWhatDiffersAndPutLongNamesBelow) {
  const std::string one = script_of("rate = [0.1, 0.2]\nseed = [1, 2]\npes = ['8x8']\n", "x = 'rate'\n");
  EXPECT_THAT(one, testing::HasSubstr("title 'seed 1' "));
  EXPECT_THAT(one, testing::HasSubstr("set key outside right"));
  const std::string more = script_of("rate = [0.1]\nseed = [1, 2]\ntraffic = ['uniform', 'tornado']\n", "x = 'rate'\n");
  EXPECT_THAT(more, testing::HasSubstr("title 'seed 1, traffic uniform' "));
  EXPECT_THAT(more, testing::HasSubstr("set key below"));
}

// gnuplot leaves out a point at 0 of a logarithmic axis, and says nothing.
TEST(Plots, AnAxisWithA0IsNotLogarithmic) {
  const std::string report = "x = 'seed'\nlog_x = true\nlog_y = true\n";
  EXPECT_THAT(script_of("seed = [0, 1, 2]\n", report), testing::Not(testing::HasSubstr("logscale x")));
  EXPECT_THAT(script_of("seed = [0, 1, 2]\n", report), testing::HasSubstr("logscale y"));
  EXPECT_THAT(script_of("seed = [1, 2]\n", report), testing::HasSubstr("logscale x 2"));
}

// What no point is compared with has no speed-up, rather than one against some other run.
TEST(Tables, WithoutItsBaselineAPointHasNoSpeedUp) {
  SmallStudy study;
  study.plan.report.baseline["pes"] = "9x9";
  EXPECT_THAT(csv_of(study.table()), testing::HasSubstr("\n2x2,skewed:zy,,4,1000,"));
  EXPECT_THROW(check_baseline(study.plan, study.points), InputError);
  study.plan.report.baseline["pes"] = "2x2";
  EXPECT_NO_THROW(check_baseline(study.plan, study.points));
  study.plan.report.baseline["size"] = "8x8";
  EXPECT_THROW(check_baseline(study.plan, study.points), InputError) << "nor does it vary";
}

}  // namespace
}  // namespace torolux::study
