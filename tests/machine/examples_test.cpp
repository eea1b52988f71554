// SPDX-License-Identifier: MIT
// The examples of firmware of one's own: each checks its result by itself, says the same in the same cycles on every
// engine and any number of threads, and refuses arguments that it cannot use.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/machine/process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using testing_support::TemporaryFolder;

std::string image(const std::string& name) {
  return (std::filesystem::path(TOROLUX_FIRMWARE_DIR) / (name + ".elf")).string();
}

struct Example {
  std::string name;
  std::string pes;
  std::vector<std::string> arguments;
};

Finished run(const Example& example, const std::vector<std::string>& options) {
  std::vector<std::string> words = {"run", image(example.name), "--pes", example.pes, "--quiet"};
  words.insert(words.end(), options.begin(), options.end());
  if (!example.arguments.empty()) words.emplace_back("--");
  words.insert(words.end(), example.arguments.begin(), example.arguments.end());
  return run_torolux(words);
}

struct Outcome {
  std::string output;
  std::string hash;
  std::uint64_t cycles;

  bool operator==(const Outcome&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Outcome& outcome) {
  return out << outcome.output << "hash " << outcome.hash << ", cycles " << outcome.cycles;
}

Outcome outcome_of(const Example& example, std::vector<std::string> options) {
  const TemporaryFolder folder;
  const std::filesystem::path stats = folder.path() / "stats.json";
  options.insert(options.end(), {"--stats", stats.string()});
  const Finished end = run(example, options);
  EXPECT_EQ(end.exit_code, 0) << end.errors;
  if (end.exit_code != 0) return {};
  const nlohmann::json json = statistics(stats);
  return {end.output, json["trace_hash"], json["virtual_cycles"]["total"]};
}

class EveryExample : public testing::TestWithParam<Example> {};

TEST_P(EveryExample, SaysTheSameInTheSameCyclesOnEveryEngine) {
  const Outcome translated = outcome_of(GetParam(), {"--engine", "translated", "--threads", "1"});
  EXPECT_FALSE(translated.output.empty());
  EXPECT_EQ(outcome_of(GetParam(), {"--engine", "translated", "--threads", "2"}), translated);
  EXPECT_EQ(outcome_of(GetParam(), {"--engine", "interpreted"}), translated);
  EXPECT_EQ(outcome_of(GetParam(), {"--engine", "qemu"}), translated);
}

// Tori of one PE, of a single row, and with odd edges, where rings close over links of other lengths.
INSTANTIATE_TEST_SUITE_P(Examples, EveryExample,
                         testing::Values(Example{"ring_sum", "3x2", {}}, Example{"all_reduce", "3x3", {"ring", "100"}},
                                         Example{"all_reduce", "1x1", {"ring", "7", "2"}},
                                         Example{"all_reduce", "4x2", {"tree", "100", "3"}},
                                         Example{"sort", "3x2", {"2000", "check"}},
                                         Example{"sort", "1x1", {"100", "check"}},
                                         Example{"sort", "5x1", {"3", "check"}}, Example{"heat", "3x2", {"24", "10"}},
                                         Example{"heat", "1x4", {"9", "5"}},
                                         Example{"matrix_product", "3x3", {"21", "check"}},
                                         Example{"matrix_product", "1x1", {"9", "check"}}),
                         [](const auto& example) { return example.param.name + "_" + std::to_string(example.index); });

TEST(Examples, TheSumOverARingIsRight) {
  EXPECT_THAT(run({"ring_sum", "4x4", {}}, {"--raw"}).output, StartsWith("1 + 2 + ... + 16 = 136, after "));
}

TEST(Examples, HeatIsTheSamePlateOnAnyTorus) {
  std::map<std::string, std::string> plates;
  for (const char* pes : {"1x1", "4x2", "3x3"}) {
    const TemporaryFolder folder;
    const std::string picture = (folder.path() / "plate.ppm").string();
    const Finished end = run({"heat", pes, {"30", "40"}}, {"--output", "plate.ppm=" + picture});
    EXPECT_EQ(end.exit_code, 0) << end.errors;
    plates[pes] = contents(picture);
  }
  EXPECT_THAT(plates["1x1"], StartsWith("P6 30 30 255\n"));
  EXPECT_EQ(plates["1x1"].size(), 13U + 30 * 30 * 3);
  EXPECT_TRUE(plates["4x2"] == plates["1x1"]);
  EXPECT_TRUE(plates["3x3"] == plates["1x1"]);
}

TEST(Examples, ArgumentsThatCannotBeUsedAreRefused) {
  for (const Example& wrong : std::vector<Example>{{"all_reduce", "2x2", {}},
                                                   {"all_reduce", "2x2", {"star", "9"}},
                                                   {"all_reduce", "2x2", {"ring", "3"}},
                                                   {"all_reduce", "2x2", {"tree", "4", "0"}},
                                                   {"sort", "2x2", {"0"}},
                                                   {"sort", "2x2", {"9", "twice"}},
                                                   {"heat", "2x2", {"1", "1"}},
                                                   {"matrix_product", "2x1", {"8"}},
                                                   {"matrix_product", "2x2", {"9"}},
                                                   {"matrix_product", "2x2", {"8", "twice"}}}) {
    const Finished end = run(wrong, {});
    EXPECT_EQ(end.exit_code, 1) << wrong.name;
    EXPECT_THAT(end.errors, HasSubstr("argument")) << wrong.name;
  }
}

}  // namespace
}  // namespace torolux::test
