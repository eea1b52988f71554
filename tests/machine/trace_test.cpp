// SPDX-License-Identifier: MIT
// Proves: the trace of a run is whole, is what the statistics say, and is the same bytes whatever runs the machine;
// with it, cycles, statistics and picture are what they are without.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <limits>

#include "tests/machine/process.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/trace_reader.hpp"

namespace torolux::test {
namespace {

using testing::HasSubstr;
using testing_support::read_trace;
using testing_support::ReadEvent;
using testing_support::ReadTrace;
using testing_support::TemporaryFolder;

const std::string kScene = std::string(TOROLUX_SOURCE_DIR) + "/scenes/cornell_box";
constexpr double kNanoseconds = 10;  // of a cycle, at 100 MHz

std::string image(const std::string& name) {
  return (std::filesystem::path(TOROLUX_FIRMWARE_DIR) / (name + ".elf")).string();
}

/// A small render of 6 PEs into the folder, picture.png; what it wrote.
Finished render(const TemporaryFolder& folder, const std::vector<std::string>& more) {
  std::vector<std::string> words = {"render", kScene};
  for (const std::string& word : small_render_options()) words.push_back(word);
  for (const char* word : {"--pes", "3x2", "--max-shots", "2", "--emission-records", "5000", "--quiet", "--output"})
    words.emplace_back(word);
  words.push_back((folder.path() / "picture.png").string());
  words.insert(words.end(), more.begin(), more.end());
  Finished finished = run_torolux(words);
  EXPECT_EQ(finished.exit_code, 0) << finished.errors;
  return finished;
}

std::string trace_of(const TemporaryFolder& folder, std::vector<std::string> more) {
  const auto file = folder.path() / "run.pftrace";
  more.insert(more.end(), {"--trace", file.string()});
  render(folder, more);
  return contents(file);
}

std::uint64_t pe_track(const ReadTrace& trace, unsigned pe) {
  return trace.track(
      "PE " + std::to_string(pe) + " (x " + std::to_string(pe % 3) + ", y " + std::to_string(pe / 3) + ")",
      trace.track("row " + std::to_string(pe / 3)));
}

/// Busy cycles by phase, and waits, as statistics and traces name them.
void expect_same_shares(const ReadTrace& trace, const nlohmann::json& pe, unsigned number, double tolerance) {
  const auto lengths = trace.lengths(pe_track(trace, number));
  const auto shown = [&](const std::string& name) {
    const auto found = lengths.find(name);
    return found != lengths.end() ? static_cast<double>(found->second) / kNanoseconds : 0.0;
  };
  for (const auto& [phase, cycles] : pe.at("phase_cycles").items()) {
    const std::string name = phase == "outside" ? "no phase" : phase;
    EXPECT_NEAR(shown(name), cycles.get<double>(), tolerance) << "PE " << number << phase;
  }
  for (const auto& [reason, cycles] : pe.at("waits").items()) {
    std::string name = "wait: " + reason;
    std::replace(name.begin(), name.end(), '_', ' ');
    EXPECT_NEAR(shown(name), cycles.get<double>(), tolerance) << "PE " << number << name;
  }
  EXPECT_NEAR(shown("idle at the end"), pe.at("idle_at_end").get<double>(), tolerance) << "PE " << number;
}

/// What a counter's values may be at most.
double most_of(const testing_support::ReadTrack& counter, const nlohmann::json& pes) {
  const auto high_water = [&pes](const char* key) {
    double most = 0;
    for (const auto& pe : pes) most = std::max(most, pe.at(key).get<double>());
    return most;
  };
  if (counter.unit == "%") return 100;
  if (counter.name == "record slots in use") return high_water("record_slots_high_water");
  if (counter.name == "receive buffers in use") return high_water("receive_buffers_high_water");
  return std::numeric_limits<double>::max();
}

TEST(Trace, IsWholeAndSaysWhatTheStatisticsSay) {
  const TemporaryFolder folder;
  const auto stats = (folder.path() / "stats.json").string();
  const ReadTrace exact = read_trace(
      trace_of(folder, {"--trace-grain", "1", "--trace-arrows", "7", "--stats", stats, "--trace-limit", "1G"}));
  const nlohmann::json statistics = test::statistics(stats);
  EXPECT_EQ(exact.wrong, std::vector<std::string>());
  for (unsigned pe = 0; pe < 6; ++pe) expect_same_shares(exact, statistics.at("pes").at(pe), pe, 0);
  EXPECT_GT(exact.arrows(), 10U);
  std::uint64_t end = 0;
  for (const ReadEvent& event : exact.events) {
    end = std::max(end, event.time);
    if (event.type != ReadEvent::counter) continue;
    EXPECT_GE(event.value, 0);
    const auto& track = exact.tracks.at(event.track);
    EXPECT_LE(event.value, most_of(track, statistics.at("pes"))) << track.name;
  }
  EXPECT_EQ(static_cast<double>(end) / kNanoseconds, statistics.at("virtual_cycles").at("total").get<double>());
  // With grains, each state is right to within a few of them: who is owed most gets the next.
  const ReadTrace coarse = read_trace(trace_of(folder, {"--trace-grain", "8192"}));
  EXPECT_EQ(coarse.wrong, std::vector<std::string>());
  for (unsigned pe = 0; pe < 6; ++pe) expect_same_shares(coarse, statistics.at("pes").at(pe), pe, 4 * 8192.0);
}

TEST(Trace, IsTheSameWhateverRunsTheMachine) {
  const TemporaryFolder folder;
  const std::vector<std::string> options = {"--trace-grain", "64", "--trace-arrows", "3"};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = options;
    words.insert(words.end(), more.begin(), more.end());
    return trace_of(folder, words);
  };
  const std::string reference = with({"--threads", "1"});
  EXPECT_EQ(read_trace(reference).wrong, std::vector<std::string>());
  EXPECT_TRUE(with({"--threads", "4"}) == reference);
  EXPECT_TRUE(with({"--engine", "interpreted"}) == reference);
  EXPECT_TRUE(with({"--engine", "qemu"}) == reference);
}

TEST(Trace, ChangesNothingOfTheRun) {
  const TemporaryFolder folder;
  const auto stats = (folder.path() / "stats.json").string();
  render(folder, {"--stats", stats});
  const nlohmann::json without = test::statistics(stats);
  const std::string picture = contents(folder.path() / "picture.png");
  trace_of(folder, {"--stats", stats, "--trace-grain", "16"});
  EXPECT_EQ(test::statistics(stats), without);
  EXPECT_TRUE(contents(folder.path() / "picture.png") == picture);
}

TEST(Trace, IsReadByTheCompilerOfTheFormat) {
  const TemporaryFolder folder;
  trace_of(folder, {"--trace-grain", "1024", "--trace-arrows", "3"});
  const std::string text = (folder.path() / "text").string();
  const std::string data = std::string(TOROLUX_SOURCE_DIR) + "/tests/data";
  const std::string command = "protoc --decode=TorusTrace --proto_path=" + data + " " + data +
                              "/perfetto_subset.proto < " + (folder.path() / "run.pftrace").string() + " > " + text;
  ASSERT_EQ(std::system(command.c_str()), 0);
  std::ifstream lines(text);
  std::size_t packets = 0, begins = 0, ends = 0, arrows = 0, arrow_ends = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string word = line.substr(std::min(line.size(), line.find_first_not_of(' ')));
    // What the description does not know stands there by its number.
    EXPECT_FALSE(!word.empty() && word.front() >= '0' && word.front() <= '9') << line;
    packets += word == "packet {" ? 1 : 0;
    begins += word == "type: SLICE_BEGIN" ? 1 : 0;
    ends += word == "type: SLICE_END" ? 1 : 0;
    arrows += word.starts_with("arrow: ") ? 1 : 0;
    arrow_ends += word.starts_with("arrow_end: ") ? 1 : 0;
  }
  EXPECT_GT(packets, 1000U);
  EXPECT_GT(begins, 100U);
  EXPECT_EQ(begins, ends);
  EXPECT_GT(arrows, 10U);
  EXPECT_EQ(arrows, arrow_ends);
}

TEST(Trace, OfAnyImageHasEveryState) {
  const TemporaryFolder folder;
  const auto file = (folder.path() / "hello.pftrace").string();
  const Finished run = run_torolux({"run", image("hello"), "--pes", "3x2", "--trace", file});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const ReadTrace trace = read_trace(contents(file));
  EXPECT_EQ(trace.wrong, std::vector<std::string>());
  for (unsigned pe = 0; pe < 6; ++pe) {
    const auto lengths = trace.lengths(pe_track(trace, pe));
    EXPECT_TRUE(lengths.contains("program") && lengths.contains("halted")) << pe;
  }
}

TEST(Trace, WhatDoesNotGoIsRefused) {
  const TemporaryFolder folder;
  const auto file = (folder.path() / "a").string();
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"run", image("hello"), "--pes", "3x2"});
    return run_torolux(more);
  };
  EXPECT_THAT(run({"--trace-grain", "4"}).errors, HasSubstr("--trace FILE says where"));
  EXPECT_EQ(run({"--trace-grain", "4"}).exit_code, 1);
  EXPECT_THAT(run({"--trace", file, "--trace-grain", "5"}).errors, HasSubstr("power of two"));
  EXPECT_THAT(run({"--trace", file, "--trace-pes", "0-6"}).errors,
              HasSubstr("there is no PE 6; the machine has 0 to 5"));
  EXPECT_THAT(run({"--trace", file, "--trace-window", "5:5"}).errors, HasSubstr("ends before it begins"));
  EXPECT_THAT(run({"--trace", file, "--trace-limit", "1K"}).errors, HasSubstr("out of range"));
  EXPECT_THAT(run({"--trace", file, "--stats", file}).errors, HasSubstr("--stats"));
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace torolux::test
