// SPDX-License-Identifier: MIT
// Start-up code, linker script, NIU driver and the example images, run on each engine in the whole machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "emulator/engines/image/source_line.hpp"
#include "emulator/errors.hpp"
#include "host_tools/run/run.hpp"
#include "tests/images/run_support.hpp"

namespace torolux {
namespace {

using test::line_with;
using testing::AllOf;
using testing::HasSubstr;

struct Outcome {
  std::vector<PeText> texts;
  MachineFigures figures;
};

Outcome run(const char* engine, const std::string& image_name, unsigned columns, unsigned rows) {
  const Image image = load_image(std::filesystem::path(TOROLUX_FIRMWARE_DIR) / (image_name + ".elf"));
  MachineSetup setup;
  setup.columns = columns;
  setup.rows = rows;
  setup.local_memory_bytes = protocol::kSmallestLocalMemory;
  setup.engine = engine;
  Outcome result;
  result.figures = run_image(setup, image, [&](const PeText& text) { result.texts.push_back(text); }, {});
  return result;
}

/// Runs `faults` with as many rows as the fault's number; returns the message with which the machine fails.
std::string failure_of_fault(const char* engine, unsigned fault) {
  try {
    run(engine, "faults", 1, fault);
  } catch (const MachineFailure& failure) {
    return failure.what();
  }
  return "no failure";
}

class ExampleImages : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Engines, ExampleImages, testing::Values("qemu", "translated", "interpreted"));

TEST_P(ExampleImages, HelloSendsOneLineFromEachPe) {
  const Outcome result = run(GetParam(), "hello", 3, 2);
  std::vector<std::string> lines;
  for (const PeText& text : result.texts) {
    EXPECT_EQ(text.text, "Hello from PE " + std::to_string(text.pe) + " of 6");
    lines.push_back(text.text);
  }
  EXPECT_EQ(lines.size(), 6U);
}

TEST_P(ExampleImages, TokenPassesEachPeOnce) {
  const Outcome result = run(GetParam(), "token", 3, 2);
  ASSERT_EQ(result.texts.size(), 1U);
  EXPECT_EQ(result.texts[0].pe, 0);
  EXPECT_THAT(result.texts[0].text, HasSubstr("passed 6 PEs"));
  for (const PeFigures& pe : result.figures.pes) {
    EXPECT_EQ(pe.packets_sent, 1U);
    EXPECT_EQ(pe.packets_delivered, 1U);
  }
}

TEST_P(ExampleImages, TokenTakesTheSameCyclesEachTime) {
  const Outcome once = run(GetParam(), "token", 2, 2);
  const Outcome again = run(GetParam(), "token", 2, 2);
  EXPECT_EQ(once.texts.at(0).text, again.texts.at(0).text);
  EXPECT_EQ(once.figures.now, again.figures.now);
}

TEST(Jumps, EveryLegalOneIsTheSameOnAllEngines) {
  const char* expected[] = {"other link 42 ", "own link 42 ", "labels 4721 ",
                            "squares 385 ",   "paths 252 ",   "numbers -1 2.5 -0.000001 1 true x 1099511627776 7"};
  constexpr std::size_t kCounters = 20;  // lines before those
  const Outcome qemu = run("qemu", "jumps", 1, 1);
  ASSERT_EQ(qemu.texts.size(), kCounters + std::size(expected));
  for (std::size_t n = 0; n < std::size(expected); ++n) {
    EXPECT_THAT(qemu.texts[kCounters + n].text, testing::StartsWith(expected[n]));
  }
  for (const char* engine : {"translated", "interpreted"}) {
    const Outcome other = run(engine, "jumps", 1, 1);
    ASSERT_EQ(other.texts.size(), qemu.texts.size()) << engine;
    for (std::size_t n = 0; n < qemu.texts.size(); ++n) {
      EXPECT_EQ(other.texts[n].text, qemu.texts[n].text) << engine;  // the clock and the counters, too
    }
    EXPECT_EQ(other.figures.trace_hash, qemu.figures.trace_hash) << engine;
    EXPECT_EQ(other.figures.instructions(), qemu.figures.instructions()) << engine;
  }
}

// What the fault is, and what the message must hold. mtval where it is a fixed address.
class Faults : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Engines, Faults, testing::Values("qemu", "translated", "interpreted"));

TEST_P(Faults, StoreAfterLocalMemoryTraps) {
  EXPECT_THAT(failure_of_fault(GetParam(), 1), AllOf(HasSubstr("PE 0"), HasSubstr("store"), HasSubstr("0x80040000")));
}
TEST_P(Faults, LoadFromADeviceTraps) {
  EXPECT_THAT(failure_of_fault(GetParam(), 2), AllOf(HasSubstr("PE "), HasSubstr("load"), HasSubstr("0x10000000")));
}
TEST_P(Faults, StoreIntoCodeTraps) {
  EXPECT_THAT(failure_of_fault(GetParam(), 3),
              AllOf(HasSubstr("PE "), HasSubstr("store into a page of code"), HasSubstr("0x80000000")));
}
TEST_P(Faults, StackOverflowTrapsInItsFunction) {
  EXPECT_THAT(failure_of_fault(GetParam(), 4),
              AllOf(HasSubstr("PE "), HasSubstr("a stack overflow?"), HasSubstr("fill_stack")));
}
TEST_P(Faults, ExecutingTheStoresTraps) {
  EXPECT_THAT(failure_of_fault(GetParam(), 5), AllOf(HasSubstr("PE "), HasSubstr("trap"), HasSubstr("0x8003fffc")));
}
TEST_P(Faults, UnknownInstructionTraps) {
  EXPECT_THAT(failure_of_fault(GetParam(), 6),
              AllOf(HasSubstr("PE "), HasSubstr("trap"), HasSubstr("illegal instruction")));
}
TEST_P(Faults, AProgramsOwnFailureEndsTheRun) {
  EXPECT_THAT(failure_of_fault(GetParam(), 7),
              AllOf(HasSubstr("PE "), HasSubstr("bad record: side of the patch that it hits = 6")));
}
TEST_P(Faults, MisalignedAccessAndTheLastWordWork) {
  EXPECT_EQ(failure_of_fault(GetParam(), 8), "no failure");
}

// ---- What was said before an end ----

struct LastWords {
  std::vector<std::string> of_pe_0;
  std::string failure;
};

/// Two columns of PEs say eight lines each; then PE 0 ends as the number of rows says.
LastWords last_words(const char* engine, unsigned how, unsigned threads) {
  const Image image = load_image(std::filesystem::path(TOROLUX_FIRMWARE_DIR) / "last_words.elf");
  MachineSetup setup;
  setup.columns = 2;
  setup.rows = how;
  setup.local_memory_bytes = protocol::kSmallestLocalMemory;
  setup.engine = engine;
  setup.threads = threads;
  setup.description.processor.most_cycles_between_hints = 1'000'000;
  LastWords result;
  const auto hear = [&](const PeText& text) {
    if (text.pe == 0) result.of_pe_0.push_back(text.text);
  };
  try {
    run_image(setup, image, hear, {});
  } catch (const MachineFailure& failure) {
    result.failure = failure.what();
  }
  return result;
}

class LastWordsOn : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Engines, LastWordsOn, testing::Values("qemu", "translated", "interpreted"));

TEST_P(LastWordsOn, AreHeardBeforeEachKindOfFailure) {
  const char* what[] = {"trap: illegal instruction", "an endless loop?", "trap: wfi", "HINT unknown to the NIU"};
  for (const unsigned how : {1U, 2U, 3U, 4U}) {
    for (const unsigned threads : {1U, 2U}) {
      const LastWords words = last_words(GetParam(), how, threads);
      EXPECT_THAT(words.failure, AllOf(testing::StartsWith("PE 0: "), HasSubstr(what[how - 1])));
      ASSERT_EQ(words.of_pe_0.size(), 8U) << words.failure;
      for (unsigned line = 0; line < 8; ++line) {
        EXPECT_EQ(words.of_pe_0[line], "line " + std::to_string(line) + " of PE 0");
      }
    }
  }
}

TEST(LastWords, AnEndlessLoopEndsInTheSameCycleAndPlaceOnAllEngines) {
  const std::string qemu = last_words("qemu", 2, 1).failure;
  EXPECT_THAT(qemu, AllOf(HasSubstr(", now at pc 0x"), HasSubstr("(torolux::pe::pe_main"), HasSubstr(" (cycle ")));
  EXPECT_EQ(last_words("qemu", 2, 2).failure, qemu);
  EXPECT_EQ(last_words("translated", 2, 1).failure, qemu);
  EXPECT_EQ(last_words("translated", 2, 2).failure, qemu);
  EXPECT_EQ(last_words("interpreted", 2, 1).failure, qemu);
}

TEST(LastWords, WaitingForAnInterruptIsTheSameTrapOnAllEngines) {
  const std::string qemu = last_words("qemu", 3, 1).failure;
  EXPECT_THAT(qemu, AllOf(testing::StartsWith("PE 0: trap: wfi at pc 0x"), HasSubstr("(torolux::pe::pe_main"),
                          HasSubstr("there are none"), HasSubstr(" (cycle ")));
  EXPECT_EQ(last_words("translated", 3, 1).failure, qemu);  // pc and cycle, too
  EXPECT_EQ(last_words("interpreted", 3, 1).failure, qemu);
}

TEST(Places, TrapsAndLoopsAreToldWithFileAndLine) {
  EXPECT_THAT(failure_of_fault("translated", 6),
              HasSubstr(", " + line_with("tests/images/faults.cpp", "(\"unimp\")") + "), mtval"));
  EXPECT_THAT(failure_of_fault("translated", 4), HasSubstr("fill_stack(unsigned long)+0x"));
  const std::string own = line_with("tests/images/last_words.cpp", "for (;;) asm");
  const std::string callers = line_with("tests/images/last_words.cpp", "tests::end(niu");
  ASSERT_FALSE(own.empty() || callers.empty());
  EXPECT_THAT(last_words("translated", 2, 1).failure,
              HasSubstr(", " + own + ", inlined at " + callers + "): an endless"));
}

TEST(Places, AnImageThatIsNotThereHasNoLines) {
  EXPECT_EQ(source_line(DebugInfo({}), 0x8000'0000U), "");
  EXPECT_EQ(
      source_line(DebugInfo(read_image_file(std::filesystem::path(TOROLUX_SOURCE_DIR) / "README.md")), 0x8000'0000U),
      "");
}

TEST(LastWords, AreHeardBeforeATrapThatNothingHandles) {
  for (const char* engine : {"translated", "interpreted", "qemu"}) {
    const LastWords words = last_words(engine, 5, 1);
    EXPECT_THAT(words.failure, AllOf(HasSubstr("trap"), HasSubstr("mtvec leads to no handler"))) << engine;
    EXPECT_EQ(words.of_pe_0.size(), 8U) << engine;
  }
}

}  // namespace
}  // namespace torolux
