// SPDX-License-Identifier: MIT
// Proves: whatever a run counts adds up, exactly: cycles of each PE, phases, bus, host, FBC and links to the virtual
// time, stages and the time line to the run; and a stage is said to be bounded by what was made to bound it.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/machine/process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

using nlohmann::json;
using testing_support::TemporaryFolder;
using Arguments = std::vector<std::string>;

json statistics_of(const std::string& scene, const Arguments& more) {
  const TemporaryFolder folder;
  Arguments arguments = small_render_options();
  arguments.insert(arguments.begin(), {"render", std::string(TOROLUX_SOURCE_DIR) + "/scenes/" + scene});
  arguments.insert(arguments.end(), {"--quiet", "--no-picture", "--stats", folder.path() / "a.json"});
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Finished finished = run_torolux(arguments);
  EXPECT_EQ(finished.exit_code, 0) << finished.errors;
  return statistics(folder.path() / "a.json");
}

std::uint64_t sum_of(const json& object) {
  std::uint64_t sum = 0;
  for (const json& value : object) sum += value.get<std::uint64_t>();
  return sum;
}

std::uint64_t number(const json& value) {
  return value.get<std::uint64_t>();
}

void expect_pes_add_up(const json& pes, std::uint64_t cycles) {
  for (const json& pe : pes) {
    const std::uint64_t busy = number(pe["busy_cycles"]);
    EXPECT_EQ(busy + sum_of(pe["waits"]) + number(pe["idle_at_end"]), number(pe["cycles"]));
    EXPECT_EQ(busy + number(pe["idle_cycles"]), number(pe["cycles"]));
    EXPECT_EQ(sum_of(pe["phase_cycles"]), busy);
    EXPECT_EQ(pe["phase_cycles"]["outside"], 0);
    if (cycles != 0) {
      EXPECT_EQ(number(pe["cycles"]), cycles);
    }
  }
}

/// What is idle is worked out from what is busy: a part that were busy for longer than there is time would show here.
void expect_within(const json& part, std::uint64_t cycles) {
  EXPECT_LE(number(part["busy_cycles"]), cycles);
  EXPECT_EQ(number(part["busy_cycles"]) + number(part["idle_cycles"]), cycles);
}

/// A number of the run is the sum of the stages' numbers.
void expect_stages_add_up(const json& stats, const json::json_pointer& key) {
  std::uint64_t sum = 0;
  for (const json& stage : stats["stages"]) sum += number(stage.at(key));
  EXPECT_EQ(sum, number(stats.at(key))) << key;
}

void expect_time_line_adds_up(const json& stats) {
  std::uint64_t bus = 0;
  std::uint64_t frame_buffer = 0;
  std::uint64_t host = 0;
  std::uint64_t packets = 0;
  double load = 0;
  const json& line = stats["time_line"];
  const auto width = number(line["slice_cycles"]);
  const std::uint64_t total = number(stats["virtual_cycles"]["total"]);
  ASSERT_EQ(line["slices"].size(), (total + width - 1) / width);
  EXPECT_LE(line["slices"].size(), 128U);
  for (std::size_t i = 0; i < line["slices"].size(); ++i) {
    const json& slice = line["slices"][i];
    bus += number(slice["bus_cycles"]);
    frame_buffer += number(slice["frame_buffer_cycles"]);
    host += number(slice["host_cycles"]);
    packets += number(slice["packets"]);
    EXPECT_LE(number(slice["bus_cycles"]), width);
    EXPECT_LE(slice["load"], 1 + 1e-9) << "a ratio of two whole numbers";
    load += slice["load"].get<double>() * static_cast<double>(std::min(width, total - i * width));
  }
  EXPECT_EQ(bus, number(stats["bus"]["busy_cycles"]));
  EXPECT_EQ(frame_buffer, number(stats["frame_buffer"]["busy_cycles"]));
  EXPECT_EQ(host, number(stats["host_processor"]["busy_cycles"]));
  EXPECT_EQ(packets, number(stats["packets"]["delivered"]));
  const auto busy = static_cast<double>(number(stats["busy_cycles"])) / static_cast<double>(stats["pes"].size());
  EXPECT_NEAR(load / busy, 1, 1e-9) << "rounding of the slices' ratios";
}

TEST(Statistics, AddUp) {
  for (const auto& [scene, pes] : {std::pair("cornell_box", "2x2"), {"cornell_box", "5x1"}, {"two_mirrors", "3x2"}}) {
    SCOPED_TRACE(std::string(scene) + " " + pes);
    // Without copies all kinds of records are sent.
    const json stats = statistics_of(scene, {"--pes", pes, "--replicate", "0"});
    const std::uint64_t total = number(stats["virtual_cycles"]["total"]);
    const json& cycles = stats["virtual_cycles"];
    EXPECT_EQ(number(cycles["load"]) + number(cycles["radiosity"]) + number(cycles["ray_tracing"]), total);
    expect_pes_add_up(stats["pes"], total);
    std::uint64_t length = 0;
    ASSERT_EQ(stats["stages"].size(), 5U);
    for (const json& stage : stats["stages"]) {
      SCOPED_TRACE(stage["name"].get<std::string>());
      EXPECT_EQ(number(stage["begin"]), length);
      length += number(stage["cycles"]);
      expect_pes_add_up(stage["pes"], 0);
      for (const char* part : {"bus", "frame_buffer", "host_processor"}) {
        expect_within(stage[part], number(stage["cycles"]));
      }
    }
    EXPECT_EQ(length, total);
    for (const char* part : {"bus", "frame_buffer", "host_processor"}) expect_within(stats[part], total);
    for (const json& router : stats["links"]) {
      for (const json& link : router) expect_within(link, total);
    }
    for (const char* key :
         {"/busy_cycles", "/idle_at_end", "/waits/arrivals", "/waits/copy", "/packets/sent", "/hops/total",
          "/bus/busy_cycles", "/bus/messages", "/bus/kinds/pixels/bytes", "/host_processor/busy_cycles",
          "/host_processor/work/message/items", "/frame_buffer/pixels_added", "/torus/flits", "/phases/traverse",
          "/phases/dispatch", "/phases/program"}) {
      expect_stages_add_up(stats, json::json_pointer(key));
    }
    for (std::size_t pe = 0; pe < stats["pes"].size(); ++pe) {
      for (const char* key : {"cycles", "busy_cycles", "instructions", "packets_sent", "packets_delivered"}) {
        expect_stages_add_up(stats, json::json_pointer("/pes/" + std::to_string(pe) + "/" + key));
      }
    }
    expect_time_line_adds_up(stats);
    std::uint64_t bytes = 0;
    for (const json& kind : stats["kinds"]) bytes += number(kind["bytes"]);
    EXPECT_EQ(bytes, sum_of(stats["histograms"]["bytes_by_hops"])) << "every record has a kind";
    EXPECT_GT(number(stats["kinds"]["light"]["records"]), 0U);
    EXPECT_GT(number(stats["kinds"]["ray"]["records"]), 0U);
    std::uint64_t records = 0;
    for (const json& round : stats["rounds"]) records += number(round["records"]);
    EXPECT_EQ(records + number(stats["rays"]), number(stats["records"]["created"]));
    EXPECT_GE(sum_of(stats["visits"]["radiosity"]), records) << "each record's light ends at least one segment";
    EXPECT_GE(sum_of(stats["visits"]["ray_tracing"]), number(stats["rays"]));
    EXPECT_EQ(stats["visits"]["radiosity"][0], 0) << "a segment is in a subspace";
    EXPECT_EQ(stats["visits"]["ray_tracing"][0], 0);
  }
}

TEST(Statistics, CountVisitsOnAnyMachineAlike) {
  // A segment is handed from PE to PE with its count.
  const json one = statistics_of("cornell_box", {"--pes", "1x1", "--subspaces", "5x4x6"});
  const json many = statistics_of("cornell_box", {"--pes", "3x4", "--subspaces", "5x4x6"});
  EXPECT_GT(number(many["packets"]["sent"]), number(one["packets"]["sent"]));
  EXPECT_EQ(one["visits"], many["visits"]);
}

std::string bounded_by(const json& stats, const std::string& stage_name) {
  for (const json& stage : stats["stages"]) {
    if (stage["name"] == stage_name) return stage["limits"]["by"];
  }
  return "no such stage";
}

TEST(Statistics, NameWhatBoundsAStage) {
  const std::string scene = "cornell_box";
  EXPECT_EQ(bounded_by(statistics_of(scene, {"--pes", "1x1"}), "radiosity"), "work");
  EXPECT_EQ(
      bounded_by(statistics_of(scene, {"--pes", "2x2", "--subspaces", "1x1x1", "--scheme", "paper"}), "radiosity"),
      "balance");
  EXPECT_EQ(bounded_by(statistics_of(scene, {"--ideal", "all", "--set", "bus.arbitration_cycles=10000"}), "load"),
            "bus");
  EXPECT_EQ(bounded_by(statistics_of(scene, {"--set", "host.clock_hertz=1e6"}), "ray_tracing"), "host");
  EXPECT_EQ(bounded_by(statistics_of(scene, {"--set", "frame_buffer.cycles_per_pixel=100000"}), "ray_tracing"),
            "frame_buffer");
}

}  // namespace
}  // namespace torolux::test
