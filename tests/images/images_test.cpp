// SPDX-License-Identifier: MIT
// Start-up code, linker script, NIU driver and the example images, run on each engine in the whole machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "emulator/errors.hpp"
#include "host_tools/run/run.hpp"

namespace torolux {
namespace {

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
  const Outcome qemu = run("qemu", "jumps", 1, 1);
  ASSERT_EQ(qemu.texts.size(), std::size(expected));
  for (std::size_t n = 0; n < std::size(expected); ++n) {
    EXPECT_THAT(qemu.texts[n].text, testing::StartsWith(expected[n]));
  }
  for (const char* engine : {"translated", "interpreted"}) {
    const Outcome other = run(engine, "jumps", 1, 1);
    ASSERT_EQ(other.texts.size(), qemu.texts.size()) << engine;
    for (std::size_t n = 0; n < qemu.texts.size(); ++n) {
      EXPECT_EQ(other.texts[n].text, qemu.texts[n].text) << engine;  // the clock, too
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
  EXPECT_THAT(failure_of_fault(GetParam(), 7), AllOf(HasSubstr("PE "), HasSubstr("5"), HasSubstr("6")));
}
TEST_P(Faults, MisalignedAccessAndTheLastWordWork) {
  EXPECT_EQ(failure_of_fault(GetParam(), 8), "no failure");
}

}  // namespace
}  // namespace torolux
