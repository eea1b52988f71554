// SPDX-License-Identifier: MIT
// Proves: the statistics hold every key that is promised, with the run's own figures, and only wall_seconds and host
// depend on the computer.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/unit/cli/made_up_run.hpp"

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

TEST(ClosingError, IsTheWorstChannelRelativeToItsOwnEmission) {
  EXPECT_NEAR(closing_error(made_up_figures().energy), 1e-5, 1e-12) << "0.001 of 100 W of red";
  EXPECT_EQ(closing_error(EnergyBalance{}), 0);
}

}  // namespace
}  // namespace torolux
