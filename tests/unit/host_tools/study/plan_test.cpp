// SPDX-License-Identifier: MIT
// Proves: a plan says what it is to say, and what is wrong with one is named with file and line. The plans of the
// repository are plans.
#include "host_tools/study/plan.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "emulator/errors.hpp"
#include "host_tools/files/shell_line.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/study/options.hpp"
#include "host_tools/study/points.hpp"
#include "host_tools/study/report_names.hpp"
#include "host_tools/study/results.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::study {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

std::string refusal(const std::string& text) {
  return testing_support::message_of<InputError>([&] { parse_plan(text, "plan.toml"); });
}

const std::string kBase = "[base]\ncommand = 'render'\nscene = 'room'\n";

void check_report(const std::string& base, const std::string& report) {
  check_report_names(parse_plan(base + "[vary]\npes = ['1x1', '2x2']\n[report]\n" + report, "plan.toml"));
}

std::string report_refusal(const std::string& base, const std::string& report) {
  return testing_support::message_of<InputError>([&] { check_report(base, report); });
}

TEST(Plan, WhatIsSetWithoutAValueIsTrueOrFalseAndNothingElse) {
  EXPECT_EQ(refusal(kBase + "two-sided-lights = 'true'\n"),
            "plan.toml:4: 'two-sided-lights' is 'true'; allowed are true and false, without quotes");
  EXPECT_THAT(refusal(kBase + "two-sided-lights = 1\n"), HasSubstr("is '1'; allowed are true and false"));
  EXPECT_THAT(refusal(kBase + "[vary]\ntwo-sided-lights = [true, 'false']\n"), StartsWith("plan.toml:5: 'two-sided"));
  EXPECT_EQ(refusal(kBase + "samples = true\n"),
            "plan.toml:4: 'samples' is true; allowed is a text or a number, or false: without it");
  EXPECT_NO_THROW(parse_plan(kBase + "samples = false\ndisplay = true\n", "plan.toml"));
  EXPECT_NO_THROW(parse_plan(kBase + "two-sided-lights = true\nmachine.torus.bubble = 'true'\n", "plan.toml"))
      << "what a machine allows its run says";
}

TEST(Plan, NamesOfFiguresThatNoRunHasAreRefusedBeforeTheFirst) {
  EXPECT_EQ(report_refusal(kBase, "x = 'pes'\ny = ['cycles',\n 'hops.meen']\n"),
            "plan.toml:9: [report]: no run has a figure 'hops.meen'; did you mean 'hops.mean'?");
  EXPECT_THAT(report_refusal(kBase, "y = 'cycles.paint'\n"), StartsWith("plan.toml:7: [report]: no run has a figure"));
  EXPECT_THAT(report_refusal(kBase, "\nx = 'pe_cout'\n"), StartsWith("plan.toml:8: [report]: no run has a figure"));
  EXPECT_THAT(report_refusal(kBase, "by = 'sise'\n"), StartsWith("plan.toml:7: [report]: no run has a figure"));
  EXPECT_THAT(report_refusal(kBase, "y = ['pes.0.bussy_cycles']\n"), HasSubstr("'pes.0.busy_cycles'"));
  EXPECT_THAT(report_refusal(kBase, "y = ['pes.x.busy_cycles']\n"), StartsWith("plan.toml:7:"));
  for (const char* name : {"speed_up.radiosity", "pes.3.busy_cycles", "stages.2.limits.shares.bus", "energy.emitted.1",
                           "kinds.light.packets", "phases.my own", "settings.camera.eye.0", "draft.splits", "pes",
                           "histograms.bytes_by_hops.3", "rounds.17.tail", "links.2.west.flits", "memory.needed",
                           "path.3.virtual_cycles", "host_processor.work.copy.items", "wall_seconds"})
    EXPECT_NO_THROW(check_report(kBase, "y = ['" + std::string(name) + "']\n")) << name;
  const std::string run = "[base]\ncommand = 'run'\nimage = 'a.elf'\n";
  EXPECT_NO_THROW(check_report(run, "y = ['bus.busy_cycles', 'phases.sort']\n"));
  EXPECT_THAT(report_refusal(run, "y = ['energy.emitted.0']\n"), StartsWith("plan.toml:7:"));
  const std::string network = "[base]\ncommand = 'network'\n";
  EXPECT_NO_THROW(check_report(network, "y = ['accepted']\n"));
  EXPECT_EQ(report_refusal(network, "y = ['acepted']\n"),
            "plan.toml:6: [report]: no run has a figure 'acepted'; did you mean 'accepted'?");
}

TEST(Plan, SaysWhatRunsAndInTheOrderOfTheFile) {
  const Plan plan = parse_plan(kBase +
                                   "pes = '8x8'\nmax-shots = 400\nunshot = 0.1\nstudio = true\nthreads = 2\n"
                                   "machine.torus.flit_bytes = 16\n"
                                   "[vary]\nsize = ['8x8', '9x9']\nmachine.torus.bubble = [true, false]\n"
                                   "'allocation' = ['block', 'skewed']\nzip = [['size', 'allocation']]\n"
                                   "[report]\nx = 'pe_count'\ny = ['cycles']\nbaseline = {pes = '1x1'}\n",
                               "folder/plan.toml");
  EXPECT_EQ(plan.threads, 2U);
  EXPECT_EQ(shell_line(words_of(plan, plan.base)),
            "render folder/room --pes 8x8 --max-shots 400 --unshot 0.1 --studio --set torus.flit_bytes=16");
  ASSERT_EQ(plan.vary.size(), 3U);
  EXPECT_EQ(plan.vary[0].name, "size");
  EXPECT_EQ(plan.vary[1].name, "machine.torus.bubble");
  EXPECT_EQ(plan.vary[1].values[1].value, "false");
  EXPECT_EQ(plan.vary[2].name, "allocation");
  EXPECT_THAT(plan.zip, ElementsAre(ElementsAre("size", "allocation")));
  EXPECT_EQ(plan.report.baseline.at("pes"), "1x1");
}

TEST(Plan, ArgumentsOfTheProgramStandLastAlsoBehindWhatAStudyAdds) {
  const Plan plan = parse_plan(
      "[base]\ncommand = 'run'\nimage = 'a.elf'\narguments = [512, '-v']\npes = '2x2'\n"
      "[vary]\narguments = [7, 'a b', ['c', 8]]\n",
      "folder/plan.toml");
  const std::vector<PlanOption>& options = plan.base;
  EXPECT_EQ(shell_line(words_of(plan, options)), "run folder/a.elf --pes 2x2 -- 512 -v");
  ASSERT_EQ(plan.vary.size(), 1U);
  EXPECT_EQ(plan.vary[0].values[0].value, "7");
  EXPECT_EQ(plan.vary[0].values[1].value, "a b");
  EXPECT_EQ(plan.vary[0].values[2].value, "c 8");
  const std::string run_base = "[base]\ncommand = 'run'\nimage = 'a.elf'\n";
  EXPECT_THAT(refusal(run_base + "arguments = ['a b']\n"), HasSubstr("plan.toml:4: an argument in a plan is a text"));
  EXPECT_THAT(refusal(run_base + "arguments = [['a']]\n"), HasSubstr("an argument in a plan is a text"));
  EXPECT_THAT(refusal(run_base + "pes = ['2x2']\n"), HasSubstr("'pes' must be a text, a number, or true or false"));
  const testing_support::TemporaryFolder folder;
  KeyedRun run;
  run.words = words_of(plan, options);
  run.key = "key";
  EXPECT_THAT(shell_line(words_for_result(run, ResultFolder(folder.path(), "run"), 3)),
              testing::MatchesRegex("run folder/a.elf --pes 2x2 --threads 3 --quiet --stats .*key.json -- 512 -v"));
}

TEST(Plan, NumbersAreExact) {
  const Plan plan = parse_plan(kBase + "unshot = 0.1\nfov = 39.300000000000004\nseed = 9223372036854775807\n", "p");
  EXPECT_EQ(shell_line(words_of(plan, plan.base)),
            "render room --unshot 0.1 --fov 39.300000000000004 --seed 9223372036854775807");
}

TEST(Plan, WrongOnesAreRefusedWithFileAndLine) {
  EXPECT_THAT(refusal(""), StartsWith("plan.toml:1: a plan has a table [base]"));
  EXPECT_THAT(refusal("[base\n"), StartsWith("plan.toml:1: not valid TOML"));
  EXPECT_THAT(refusal("[base]\nscene = 'a'\n"), HasSubstr("[base] lacks 'command'"));
  EXPECT_THAT(refusal("[base]\ncommand = 'paint'\n"), StartsWith("plan.toml:2: \"paint\" is no command"));
  EXPECT_THAT(refusal("[base]\ncommand = 'bench'\n"), StartsWith("plan.toml:2:"));
  EXPECT_THAT(refusal(kBase + "max-shoots = 1\n"), HasSubstr("plan.toml:4:"));
  EXPECT_THAT(refusal(kBase + "max-shoots = 1\n"), HasSubstr("did you mean 'max-shots'?"));
  EXPECT_THAT(refusal(kBase + "[base.machine.torus]\nflit_bites = 1\n"), HasSubstr("plan.toml:5:"));
  EXPECT_THAT(refusal(kBase + "[base.machine.torus]\nflit_bites = 1\n"),
              HasSubstr("did you mean 'machine.torus.flit_bytes'?"));
  for (const char* option : {"output = 'a.png'", "stats = 'a'", "quiet = true", "gdb = '0:0'", "no-picture = true"})
    EXPECT_THAT(refusal(kBase + option + "\n"), StartsWith("plan.toml:4:")) << option;
  EXPECT_THAT(refusal(kBase + "pes = ['1x1']\n"), StartsWith("plan.toml:4: 'pes' must be"));
  EXPECT_THAT(refusal(kBase + "threads = 0\n"), StartsWith("plan.toml:4:"));
  EXPECT_THAT(refusal(kBase + "[vary]\npes = '1x1'\n"), StartsWith("plan.toml:5: 'pes' varies: it must be a list"));
  EXPECT_THAT(refusal(kBase + "[vary]\npes = []\n"), StartsWith("plan.toml:5:"));
  EXPECT_THAT(refusal(kBase + "[vary]\npes = [['1x1']]\n"), StartsWith("plan.toml:5:"));
  EXPECT_THAT(refusal(kBase + "[vary]\npes = ['1x1']\n[vary_one]\npes = ['2x2']\n"), HasSubstr("[vary_one]"));
  EXPECT_THAT(refusal(kBase + "[very]\n"), HasSubstr("did you mean 'vary'? Allowed are: base, "));
  EXPECT_THAT(refusal(kBase + "[xx]\n"), HasSubstr("no key 'xx'; allowed are: base, "));
  EXPECT_THAT(refusal(kBase + "[report]\nz = 'pes'\n"), StartsWith("plan.toml:5: [report] has no key"));
  EXPECT_THAT(refusal(kBase + "[report]\ny = ['cycles',\n '']\n"),
              StartsWith("plan.toml:6: [report] 'y' has an empty name"));
  EXPECT_THAT(refusal(kBase + "[report]\ny = ['a', 'b',\n 'a']\n"),
              StartsWith("plan.toml:6: [report] 'y' names 'a' twice"));
  EXPECT_THAT(refusal(kBase + "[report]\ny = 3\n"), StartsWith("plan.toml:5:"));
  EXPECT_THAT(refusal(kBase + "[report]\ny = ['a', 3]\n"), StartsWith("plan.toml:5:"));
}

TEST(Plan, ZipsListsOfOneLengthThatVary) {
  const std::string vary = kBase + "[vary]\npes = ['1x1', '2x2']\nsize = ['8x8']\n";
  EXPECT_THAT(refusal(vary + "zip = [['pes', 'size']]\n"), HasSubstr("plan.toml:7: 'zip' needs lists of one length"));
  EXPECT_THAT(refusal(vary + "zip = [['pes', 'seed']]\n"), HasSubstr("'seed', which does not vary"));
  EXPECT_THAT(refusal(vary + "zip = [['pes'], ['pes']]\n"), HasSubstr("zipped twice"));
  EXPECT_THAT(refusal(vary + "zip = 'pes'\n"), HasSubstr("list of lists"));
}

TEST(Plan, OfTheRepositoryAreRight) {
  std::size_t count = 0;
  for (const char* folder : {"/studies", "/tests/data/studies"}) {
    for (const auto& entry : std::filesystem::directory_iterator(std::string(TOROLUX_SOURCE_DIR) + folder)) {
      if (entry.path().extension() != ".toml") continue;
      EXPECT_NO_THROW(read_plan(entry.path())) << entry.path();
      ++count;
    }
  }
  EXPECT_GE(count, 3U);
}

TEST(Plan, OfTheDocumentIsOne) {
  const std::vector<std::byte> bytes = read_file(TOROLUX_SOURCE_DIR "/docs/studies.md", 1U << 20U);
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t begin = text.find("```toml\n") + 8;
  const Plan plan = parse_plan(text.substr(begin, text.find("```", begin) - begin), "docs/studies.md");
  EXPECT_EQ(points_of(plan).size(), 3U * 2 * 3) << "pes with allocation, size; base and two others";
}

TEST(ShellLine, QuotesWhatAShellWouldTakeApart) {
  EXPECT_EQ(shell_line({"a", "b c", "it's", "", "$x", "1,2"}), "a 'b c' 'it'\\''s' '' '$x' 1,2");
}

}  // namespace
}  // namespace torolux::study
