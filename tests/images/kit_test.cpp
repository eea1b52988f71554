// SPDX-License-Identifier: MIT
// Programs on the kit (firmware/kit), run on each engine in the whole machine: the same text, files, cycles and events.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "emulator/errors.hpp"
#include "host_tools/run/run.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

struct Outcome {
  std::vector<std::string> lines;  ///< "PE STREAM text"
  MachineFigures figures;
  std::optional<PeExit> exit;
  std::string failure;
};

MachineSetup machine(const char* engine, unsigned columns, unsigned rows) {
  MachineSetup setup;
  setup.columns = columns;
  setup.rows = rows;
  setup.engine = engine;
  return setup;
}

Outcome run(const MachineSetup& setup, const std::string& image_name, ServedFiles& files) {
  const Image image = load_image(std::filesystem::path(TOROLUX_FIRMWARE_DIR) / (image_name + ".elf"));
  Outcome result;
  const std::function<void(const PeText&)> hear = [&](const PeText& text) {
    result.lines.push_back(std::to_string(text.pe) + (text.stream == PeStream::errors ? " err " : " out ") + text.text +
                           (text.ended ? "" : "|"));
  };
  try {
    RunOutcome outcome = run_program(setup, image, files, hear, {});
    result.figures = std::move(outcome.figures);
    result.exit = outcome.first_exit;
  } catch (const MachineFailure& failure) {
    result.failure = failure.what();
  }
  return result;
}

Outcome run(const MachineSetup& setup, const std::string& image_name) {
  ServedFiles none({}, {});
  return run(setup, image_name, none);
}

void expect_same(const Outcome& one, const Outcome& other, const char* engine) {
  EXPECT_EQ(one.lines, other.lines) << engine;
  EXPECT_EQ(one.figures.now, other.figures.now) << engine;
  EXPECT_EQ(one.figures.trace_hash, other.figures.trace_hash) << engine;
  EXPECT_EQ(one.figures.instructions(), other.figures.instructions()) << engine;
  EXPECT_EQ(one.failure, other.failure) << engine;
}

std::uint64_t diverted(const MachineFigures& figures) {
  std::uint64_t records = 0;
  for (const PeFigures& pe : figures.pes) records += pe.records_diverted;
  return records;
}

// ---- main, printf, arguments ----

TEST(Kit, HelloWithFloatsLongNumbersAndArgumentsIsTheSameOnAllEngines) {
  MachineSetup setup = machine("translated", 2, 2);
  setup.arguments = {"-x", "two words"};
  const Outcome translated = run(setup, "kit_hello");
  EXPECT_THAT(translated.lines,
              testing::Contains("3 out Hello from PE 3 of 4, 2.500, 1099511627776, 3 arguments, the last two words"));
  EXPECT_EQ(translated.lines.size(), 4U);
  for (const char* engine : {"qemu", "interpreted"}) {
    setup.engine = engine;
    expect_same(run(setup, "kit_hello"), translated, engine);
  }
}

TEST(Kit, ArgumentsThatAreTooLongOrForNobodyAreRefused) {
  MachineSetup setup = machine("interpreted", 1, 1);
  setup.arguments = {std::string(4090, 'x')};
  EXPECT_THROW(run(setup, "kit_hello"), UsageError);
  setup.arguments = {"x"};
  EXPECT_THROW(run(setup, "hello"), UsageError);
}

// ---- Messages ----

TEST(Kit, MessagesOfAllSizesArriveWholeAndInOrder) {
  EXPECT_EQ(run(machine("interpreted", 1, 1), "kit_messages").lines, std::vector<std::string>{"0 out 901 checks held"});
  const Outcome translated = run(machine("translated", 3, 5), "kit_messages");
  EXPECT_EQ(translated.failure, "");
  EXPECT_EQ(translated.lines, std::vector<std::string>{"0 out 33575 checks held"});
}

/// Slots run out: packets come back from the host, later than those behind them.
TEST(Kit, MessagesAreInOrderWhereRecordsAreDiverted) {
  MachineSetup setup = machine("translated", 8, 8);
  const Outcome large = run(setup, "kit_messages");
  EXPECT_EQ(large.failure, "");
  EXPECT_EQ(large.lines, std::vector<std::string>{"0 out 533431 checks held"});
  EXPECT_GT(diverted(large.figures), 0U);
}

TEST(Kit, MessagesAreTheSameOnQemu) {
  MachineSetup setup = machine("translated", 2, 1);
  const Outcome translated = run(setup, "kit_messages");
  setup.engine = "qemu";
  expect_same(run(setup, "kit_messages"), translated, "qemu");
}

// ---- Files ----

std::string contents_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(Kit, FilesAreReadWrittenAppendedAndTheSameOnAllEngines) {
  const testing_support::TemporaryFolder folder;
  std::ofstream(folder.path() / "data") << "1\n2\n30\n";
  std::ofstream(folder.path() / "in") << "hello";
  Outcome first;
  for (const char* engine : {"translated", "qemu", "interpreted"}) {
    const std::vector<GivenFile> inputs = {{"data", folder.path() / "data"}, {"stdin", folder.path() / "in"}};
    const std::vector<GivenFile> outputs = {
        {"table", folder.path() / "table"}, {"log", folder.path() / "log"}, {"host", folder.path() / "host"}};
    ServedFiles files(read_inputs(inputs), outputs);
    MachineSetup setup = machine(engine, 3, 1);
    setup.arguments = {"one", "7"};
    const Outcome outcome = run(setup, "kit_files", files);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "table")) << "before the end of a good run";
    files.finish();
    EXPECT_EQ(contents_of(folder.path() / "table"), "     0       33\n     1       33\n     2       33\n");
    EXPECT_EQ(contents_of(folder.path() / "log"), "PE 0 was here\nPE 1 was here\nPE 2 was here\n");
    EXPECT_EQ(contents_of(folder.path() / "host"), "raw raw raw ");
    EXPECT_THAT(outcome.lines,
                testing::IsSupersetOf({"0 err PE 0: 2 arguments, stdin hello", "1 err PE 1: 2 arguments, stdin nothing",
                                       "2 out half a line, one, 1, 0.1, early", "2 out no end|"}));
    ASSERT_TRUE(outcome.exit);
    EXPECT_EQ(outcome.exit->pe, 1);
    EXPECT_EQ(outcome.exit->code(), 8);
    if (first.lines.empty()) first = outcome;
    expect_same(outcome, first, engine);
    std::filesystem::remove(folder.path() / "table");
  }
}

TEST(Kit, AFileThatNobodyHasGivenIsNotThere) {
  const Outcome outcome = run(machine("interpreted", 1, 1), "kit_files");
  EXPECT_THAT(outcome.failure, HasSubstr("PE 0: fopen should have failed otherwise; called at pc"))
      << "of the name that should have been an input, opened to write";
}

// ---- C++ ----

TEST(Kit, StaticObjectsContainersAndDestructorsWork) {
  const Outcome translated = run(machine("translated", 1, 1), "kit_cplusplus");
  EXPECT_THAT(translated.lines,
              ElementsAre("0 out 10 20 30 one=1 three=3 two=2 three 999 3 4", "0 out PE 0: destroyed 30",
                          "0 out PE 0: destroyed 20", "0 out PE 0: destroyed 10"));
  expect_same(run(machine("qemu", 1, 1), "kit_cplusplus"), translated, "qemu");
  expect_same(run(machine("interpreted", 1, 1), "kit_cplusplus"), translated, "interpreted");
}

// ---- The heap ----

TEST(Kit, AFullHeapGivesNullPointersAndTheLibraryStillPrints) {
  const Outcome interpreted = run(machine("interpreted", 1, 1), "kit_heap");
  EXPECT_EQ(interpreted.failure, "");
  EXPECT_THAT(interpreted.lines, ElementsAre("0 out 7 refused, good 1, kept, many 1, 1e+300",
                                             "0 out 362 digits, no more", "0 err 6.02e+23"));
  expect_same(run(machine("translated", 1, 1), "kit_heap"), interpreted, "translated");
}

// ---- Wrong uses ----

std::string failure_of_words(const std::vector<std::string>& words, const char* engine = "interpreted") {
  MachineSetup setup = machine(engine, 2, 1);
  setup.arguments = words;
  return run(setup, "kit_faults").failure;
}

std::string failure_of(const std::string& what, const char* engine = "interpreted") {
  return failure_of_words({what}, engine);
}

TEST(KitFaults, SayWhatAndWhere) {
  const auto where = [](const std::string& what) {
    return AllOf(testing::ContainsRegex("^PE [01]: "), HasSubstr(what), HasSubstr("called at pc 0x"),
                 HasSubstr("tests/images/kit_faults.c:"));
  };
  EXPECT_THAT(failure_of("pe"), where("torolux_send: there is no PE 70; the machine has PEs 0 to 1"));
  EXPECT_THAT(failure_of("negative"), where("torolux_receive: there is no PE -5"));
  EXPECT_THAT(failure_of("bytes"), where("torolux_send: a message of 1048577 bytes; the most is 1048576"));
  EXPECT_THAT(failure_of("room"), where("torolux_receive: the message of PE 0 has 200 bytes; there is room for 100"));
  EXPECT_THAT(failure_of("memory"), where("no memory for a message of 2048 bytes from PE 0"));
  EXPECT_THAT(failure_of("assert"), where("assertion \"argc == 7\" failed: "));
  EXPECT_THAT(failure_of("abort"), where("abort"));
  EXPECT_THAT(failure_of("fail"), where("the sort is wrong"));
  EXPECT_THAT(failure_of("overlap"), where("torolux_exchange: what is sent and where to receive overlap"));
  EXPECT_THAT(failure_of("broadcast"), where("torolux_broadcast: the message of PE 0 has 100 bytes"));
  EXPECT_THAT(failure_of("root"), where("torolux_reduce: there is no PE 9"));
}

TEST(KitFaults, PesThatDisagreeAreToldWithBothCalls) {
  const auto told = [](const std::string& what) {
    return AllOf(HasSubstr(what + ": all PEs must call the same, in the same order; called at pc 0x"),
                 HasSubstr("tests/images/kit_faults.c:"));
  };
  const auto failure_of_pes = [](const std::string& what) { return failure_of_words({"disagree", what}); };
  EXPECT_THAT(
      failure_of_pes("type"),
      told("PE 0: torolux_all_reduce: PE 1 calls torolux_all_reduce(..., TOROLUX_INT64, TOROLUX_SUM) where this "
           "one calls torolux_all_reduce(..., TOROLUX_DOUBLE, TOROLUX_SUM)"));
  EXPECT_THAT(
      failure_of_pes("operation"),
      told("PE 0: torolux_all_reduce: PE 1 calls torolux_all_reduce(..., TOROLUX_DOUBLE, TOROLUX_MAXIMUM) where "
           "this one calls torolux_all_reduce(..., TOROLUX_DOUBLE, TOROLUX_SUM)"));
  EXPECT_THAT(failure_of_pes("kind"),
              told("PE 1: torolux_reduce: PE 0 calls torolux_broadcast(0, ...) where this one calls torolux_reduce(1, "
                   "..., TOROLUX_FLOAT, TOROLUX_SUM)"));
  EXPECT_THAT(failure_of_pes("again"), told("PE 1: torolux_broadcast: PE 0 calls torolux_broadcast(0, ...) at another "
                                            "place in the order than this one torolux_broadcast(0, ...)"));
}

/// Nobody waits for what the other sends: it is noticed where the program ends.
TEST(KitFaults, CallsThatNobodyHasTakenPartInAreToldAtTheEnd) {
  const auto failure_of_pes = [](const std::string& what) { return failure_of_words({"disagree", what}); };
  EXPECT_THAT(failure_of_pes("roots"),
              testing::ContainsRegex("PE (0: exit: PE 1 calls torolux_broadcast\\(1, \\.\\.\\.\\) where this one calls "
                                     "torolux_broadcast\\(0|1: exit: PE 0 calls torolux_broadcast\\(0)"));
  EXPECT_THAT(failure_of_pes("without"),
              HasSubstr("PE 1: exit: PE 0 calls torolux_broadcast(0, ...), and this one ends without it"));
  EXPECT_THAT(failure_of_pes("more"), HasSubstr("PE 0: exit: PE 1 takes part in torolux_reduce(0, ..., TOROLUX_INT32, "
                                                "TOROLUX_SUM) with more bytes than this one"));
}

TEST(KitFaults, AFullHeapIsToldWithItsSize) {
  EXPECT_THAT(failure_of("heap"),
              testing::ContainsRegex("PE [01]: the heap is full, [0-9]+ bytes, and the C library needs more of it "
                                     "\\(torolux run --pe-memory\\)"));
}

TEST(KitFaults, OfTheMachineAreToldAsEver) {
  EXPECT_THAT(failure_of("stack"), HasSubstr("a stack overflow?"));
  EXPECT_THAT(failure_of("deadlock"), HasSubstr("2 PEs still wait to receive: PE 0, 1"));
  EXPECT_THAT(failure_of("host"), HasSubstr("--output host=FILE"));
  EXPECT_THAT(
      failure_of("phase"),
      HasSubstr("phase markers do not nest: the phase shift is left, but the innermost that is open is program"));
}

TEST(KitFaults, AreTheSameOnQemu) {
  for (const char* what : {"room", "assert", "phase"}) EXPECT_EQ(failure_of(what, "qemu"), failure_of(what)) << what;
}

TEST(Kit, TheFirstStatusThatIsNotZeroIsTheRunsExitCode) {
  MachineSetup setup = machine("interpreted", 2, 1);
  setup.arguments = {"exit"};
  const Outcome outcome = run(setup, "kit_faults");
  ASSERT_TRUE(outcome.exit);
  EXPECT_EQ(outcome.exit->pe, 1);
  EXPECT_EQ(outcome.exit->status, 258);
  EXPECT_EQ(outcome.exit->code(), 2);
}

}  // namespace
}  // namespace torolux
