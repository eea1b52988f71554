// SPDX-License-Identifier: MIT
// Proves: images whose PEs run on other ranks take the cycles, and leave the figures and the trace hash, of
// one process, whatever ranks, threads, placing and delays of messages; one golden value for all. What goes wrong with
// a PE, or on a rank, is told as in one process.
#include <gtest/gtest.h>

#include <chrono>

#include "tests/support/golden_sort.hpp"
#include "tests/unit/emulator/remote/remote_support.hpp"

namespace torolux::test {
namespace {

using remote::Placing;
using std::chrono_literals::operator""us;

Image image_named(const std::string& name) {
  return load_image(std::filesystem::path(TOROLUX_FIRMWARE_DIR) / (name + ".elf"));
}

MachineSetup machine_of(unsigned threads) {
  MachineSetup setup = small_machine(kGoldenColumns, kGoldenRows);
  setup.local_memory_bytes = 1U << 20U;
  setup.engine = "interpreted";  // as translated, but without a compiler
  setup.threads = threads;
  return setup;
}

/// A program of firmware/bin, with what stands behind -- on the command line.
struct Program {
  std::string name;
  std::vector<std::string> arguments;
};
constexpr unsigned kMoreThanPes = 16;
const Program kSort = {"sort", {kGoldenArguments.begin(), kGoldenArguments.end()}};

/// Programs print, and end; the host only listens.
MachineOutcome run_image(const Program& program, MachineSetup setup) {
  setup.arguments = program.arguments;
  ListeningHost host(0);
  Machine machine(setup, image_named(program.name));
  machine.run(host);
  return {host.heard, exact(machine.figures()), machine.figures()};
}

MachineOutcome run_image_on(const RanksChoice& choice, const Program& program, MachineSetup setup) {
  MachineOutcome outcome;
  const auto ends = with_ranks(choice, [&](remote::PeRanks& others) {
    setup.ranks = &others;
    outcome = run_image(program, setup);
  });
  for (const std::string& end : ends) EXPECT_EQ(end, "");
  return outcome;
}

void expect_same(const MachineOutcome& one, const MachineOutcome& other) {
  EXPECT_EQ(one.figures, other.figures);
  ASSERT_EQ(one.heard.size(), other.heard.size());
  for (std::size_t i = 0; i < one.heard.size(); ++i) {
    EXPECT_EQ(one.heard[i].time, other.heard[i].time);
    EXPECT_EQ(one.heard[i].bytes, other.heard[i].bytes);
  }
  for (std::size_t pe = 0; pe < one.raw.pes.size(); ++pe) {
    EXPECT_EQ(one.raw.pes[pe].waits, other.raw.pes[pe].waits);
    EXPECT_EQ(one.raw.pes[pe].phase_cycles, other.raw.pes[pe].phase_cycles);
    EXPECT_EQ(one.raw.pes[pe].halted, other.raw.pes[pe].halted);
  }
}

TEST(ImagesOnRanks, AreTheSameOnRanksThreadsPlacingsAndDelays) {
  const MachineOutcome alone = run_image(kSort, machine_of(1));
  EXPECT_EQ(alone.raw.trace_hash, kGoldenTraceHash);
  EXPECT_EQ(run_image(kSort, machine_of(2)).raw.trace_hash, kGoldenTraceHash);
  std::uint64_t seed = 0;
  for (const unsigned ranks : {2U, 3U, 5U, kMoreThanPes}) {
    for (const unsigned threads : {1U, 2U}) {
      for (const Placing placing : {Placing::block, Placing::cyclic, Placing::random}) {
        for (const auto most : {0us, 40us, 300us}) {
          const RanksChoice choice{.count = ranks, .placing = placing, .delays = {++seed, most}};
          const MachineOutcome outcome = run_image_on(choice, kSort, machine_of(threads));
          EXPECT_EQ(outcome.raw.trace_hash, kGoldenTraceHash) << ranks << " ranks, " << threads << " threads, placing "
                                                              << static_cast<int>(placing) << ", seed " << seed;
          expect_same(outcome, alone);
        }
      }
    }
  }
}

TEST(ImagesOnRanks, OthersToo) {
  for (const Program& program :
       {Program{"all_reduce", {"ring", "256"}}, Program{"token", {}}, Program{"ring_sum", {}}}) {
    SCOPED_TRACE(program.name);
    expect_same(run_image_on({.count = 3, .delays = {7, 100us}}, program, machine_of(1)),
                run_image(program, machine_of(1)));
  }
}

std::string failure_of_image(const Program& program, const MachineSetup& setup) {
  try {
    run_image(program, setup);
  } catch (const std::exception& failure) {
    return failure.what();
  }
  return "no failure";
}

TEST(ImagesOnRanks, TellWhatIsWrongWithTheSameWordsAndCalls) {
  const std::vector<Program> programs = {{"last_words", {}}, {"faults", {}}, {"token", {"no main takes this"}}};
  for (const Program& program : programs) {
    SCOPED_TRACE(program.name);
    const std::string expected = failure_of_image(program, machine_of(1));
    EXPECT_NE(expected, "no failure");
    std::string failure;
    with_ranks({.count = 3}, [&](remote::PeRanks& others) {
      MachineSetup setup = machine_of(1);
      setup.ranks = &others;
      failure = failure_of_image(program, setup);
    });
    EXPECT_EQ(failure, expected);
  }
}

}  // namespace
}  // namespace torolux::test
