// SPDX-License-Identifier: MIT
// Where --until ends a run, all is as it was then, on all engines and threads; what --dump keeps, also of a run that
// has failed; what is told at a timeout.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "host_tools/cli/ending_options.hpp"
#include "tests/images/run_support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux {
namespace {

using test::small_setup;
using test::tell;
using test::test_image;
using test::Told;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;

using Bytes = std::vector<std::byte>;

/// All local memories, one after the other.
Bytes memories(const Machine& machine, unsigned pes) {
  Bytes all;
  for (unsigned pe = 0; pe < pes; ++pe) {
    const auto memory = machine.local_memory(pe);
    all.insert(all.end(), memory.begin(), memory.end());
  }
  return all;
}

struct Stopped {
  Told told;
  Bytes memory;
};

Stopped run_until(const char* engine, unsigned threads, const char* image, unsigned columns, unsigned rows,
                  Cycles until) {
  MachineSetup setup = small_setup(engine, columns, rows, threads);
  setup.until = until;
  Stopped stopped;
  stopped.told = tell(setup, test_image(image),
                      [&](const Machine& machine) { stopped.memory = memories(machine, columns * rows); });
  return stopped;
}

TEST(Until, EndsTheSameRunInTheSameStateOnAllEnginesAndThreads) {
  for (const Cycles until : {1U, 700U, 3000U, 12345U}) {
    for (const char* image : {"token", "calls"}) {  // calls with 8 rows: a HINT now and then, for ever
      const Stopped qemu = run_until("qemu", 2, image, 1, 8, until);
      EXPECT_EQ(qemu.told.failure, "");
      for (const char* engine : {"translated", "interpreted"}) {
        for (const unsigned threads : {1U, 2U, 4U}) {
          const Stopped other = run_until(engine, threads, image, 1, 8, until);
          EXPECT_EQ(other.told.failure, "");
          EXPECT_EQ(other.told.lines, qemu.told.lines);
          EXPECT_EQ(other.told.figures.now, qemu.told.figures.now);
          EXPECT_EQ(other.told.figures.trace_hash, qemu.told.figures.trace_hash);
          EXPECT_EQ(other.told.figures.instructions(), qemu.told.figures.instructions());
          EXPECT_TRUE(other.memory == qemu.memory) << image << " " << engine << " " << until;
        }
      }
    }
  }
}

TEST(Until, StopsAtTheFirstHintThatIsNotBeforeIt) {
  constexpr Cycles kUntil = 5000;
  const Stopped stopped = run_until("translated", 1, "calls", 1, 8, kUntil);
  ASSERT_TRUE(stopped.told.figures.stopped);
  EXPECT_GE(stopped.told.figures.now, kUntil);
  EXPECT_LT(stopped.told.figures.now, kUntil + 1000);  // a round of `tick` is shorter
  for (const PeFigures& pe : stopped.told.figures.pes) {
    EXPECT_FALSE(pe.halted);
    EXPECT_EQ(pe.busy_cycles + pe.idle_cycles(), pe.cycles);
  }
}

TEST(Until, AfterTheEndChangesNothing) {
  const Stopped whole = run_until("translated", 2, "token", 3, 2, 0);
  const Stopped later = run_until("translated", 2, "token", 3, 2, whole.told.figures.now + 1000);
  EXPECT_FALSE(later.told.figures.stopped);
  EXPECT_EQ(later.told.figures.now, whole.told.figures.now);
  EXPECT_EQ(later.told.figures.trace_hash, whole.told.figures.trace_hash);
  EXPECT_EQ(later.told.lines, whole.told.lines);
  EXPECT_TRUE(later.memory == whole.memory);
}

TEST(Until, WhatFailsLaterHasNotFailed) {
  const Told failed = tell(small_setup("translated", 2, 1), test_image("calls"));
  EXPECT_THAT(failed.failure, HasSubstr("illegal instruction"));
  for (const char* engine : {"translated", "qemu"}) {
    const Stopped before = run_until(engine, 1, "calls", 2, 1, 100);
    EXPECT_EQ(before.told.failure, "");
    EXPECT_TRUE(before.told.figures.stopped);
  }
}

// ---- Dumps ----

/// The place is where the symbol is, the file holds what is there; a failure does not keep it from being written.
TEST(Dump, HoldsASymbolOfARunThatHasFailed) {
  const testing_support::TemporaryFolder folder;
  for (const char* engine : {"translated", "qemu"}) {
    const auto file = folder.path() / engine;
    const MachineSetup setup = small_setup(engine, 1, 1);
    const ImageSet images = test_image("calls");
    EndingOptions options;
    options.dumps = {parse_dump("0:torolux::tests::steps=" + file.string())};
    const auto dumps = checked_dumps(options, setup, images);
    const Told told = tell(setup, images, [&](const Machine& machine) { write_dumps(machine, dumps); });
    EXPECT_THAT(told.failure, HasSubstr("illegal instruction"));
    std::array<std::uint32_t, 4> steps{};
    std::ifstream stream(file, std::ios::binary);
    ASSERT_TRUE(stream.read(reinterpret_cast<char*>(steps.data()), sizeof steps));
    EXPECT_EQ(stream.peek(), std::ifstream::traits_type::eof());
    EXPECT_EQ(steps[2], 1U);  // before the trap
    EXPECT_EQ(steps[3], 0U);  // behind it
  }
}

std::string refusal_of(const std::string& text) {
  try {
    resolve_dump(parse_dump(text), small_setup("translated", 2, 2), test_image("calls"));
  } catch (const UsageError& error) {
    return error.what();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Dump, IsRefusedWhereItIsNotInLocalMemory) {
  EXPECT_EQ(refusal_of("3:0x80000000:4=a"), "");
  EXPECT_EQ(refusal_of("3:2147483648:0x40000=a"), "");
  EXPECT_THAT(refusal_of("4:0x80000000:4=a"), HasSubstr("there is no PE 4"));
  EXPECT_THAT(refusal_of("0:0x80000000:262145=a"), HasSubstr("local memory is 0x80000000 to 0x8003ffff"));
  EXPECT_THAT(refusal_of("0:0x7ffffffc:8=a"), HasSubstr("local memory"));
  EXPECT_THAT(refusal_of("0:0x8003fffe:18446744073709551615=a"), HasSubstr("local memory"));
  EXPECT_THAT(refusal_of("0:0x80000000:0=a"), HasSubstr("at least one byte"));
  EXPECT_THAT(refusal_of("0:_start=a"), HasSubstr("has no size"));
  EXPECT_THAT(refusal_of("0:torolux::tests::step=a"), HasSubstr("did you mean"));
  for (const char* wrong : {"", "0", "0:", "0:x", "0:x=", "0:=a", "x:y=a", "0:0x80000000=a", "0::4=a"})
    EXPECT_THAT(refusal_of(wrong), HasSubstr("is not of the form")) << wrong;
}

// ---- Timeouts ----

/// Where PEs stand in a run that would never end, as soon as all have got there.
std::string standing(const char* engine) {
  MachineSetup setup = small_setup(engine, 2, 9);
  setup.description.processor.most_cycles_between_hints = ~std::uint64_t{0} >> 2U;
  std::string text;
  const auto look = [&](const Machine& machine, Cycles) {
    text = machine.where_pes_stand();
    return text.find("17 PEs wait in receive") == std::string::npos ||
           text.find("1 PE runs in pe_main") == std::string::npos;
  };
  EXPECT_THROW(run_image(
                   setup, test_image("calls"), [](const PeText&) {}, look),
               Interrupted);
  return text;
}

TEST(Timeouts, TellWhereEachPeStands) {
  for (const char* engine : {"translated", "interpreted", "qemu"}) {
    EXPECT_THAT(standing(engine),
                AllOf(ContainsRegex("17 PEs wait in receive at tests/images/calls.cpp:[0-9]+, pc 0x"),
                      ContainsRegex("1 PE runs in pe_main at tests/images/calls.cpp:[0-9]+, pc 0x[0-9a-f]+ "
                                    "\\(0\\)\n  #0 0x")))
        << engine;
  }
}

TEST(Timeouts, GiveARunUp) {
  MachineSetup setup = small_setup("translated", 1, 9);
  setup.description.processor.most_cycles_between_hints = ~std::uint64_t{0} >> 2U;
  const Timeout timeout(1);
  const auto check = [&](const Machine& machine, Cycles now) {
    timeout.check(machine, now);
    return true;
  };
  try {
    run_image(
        setup, test_image("calls"), [](const PeText&) {}, check);
    ADD_FAILURE() << "it ended";
  } catch (const MachineFailure& failure) {
    EXPECT_THAT(failure.what(), AllOf(HasSubstr("has taken 1 s"), HasSubstr("(--timeout)\n  ")));
  }
}

}  // namespace
}  // namespace torolux
