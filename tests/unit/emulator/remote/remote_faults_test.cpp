// SPDX-License-Identifier: MIT
// Proves: where ranks lose each other, whatever they are doing, each ends by itself, and rank 0 names the one that is
// lost; a slow one changes nothing. What goes wrong on a rank is told by rank 0, with the rank's name.
#include <gmock/gmock.h>

#include <chrono>

#include "tests/support/faulty_ranks.hpp"
#include "tests/unit/emulator/remote/remote_support.hpp"

namespace torolux::test {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""us;
using testing::HasSubstr;

/// Silence for so long is what no test's computer is busy for.
constexpr ranks::LifeTimes kShort{20ms, 2000ms};

NativeProgram endless() {
  return [](Niu& niu, NativeClock& clock) {
    for (;;) {
      clock.spend(1000);
      niu.receive_if_any();
    }
  };
}

TEST(RemotePes, AnErrorOnARankIsToldWithItsName) {
  const NativeProgram program = [](Niu& niu, NativeClock& /*clock*/) {
    if (niu.pe() == 4) throw std::runtime_error("no more paper");
    sleep_for_ever(niu);
  };
  ListeningHost host(1);
  const std::string failure = failure_on({.count = 3}, small_machine(3, 2), host, program);
  EXPECT_THAT(failure, HasSubstr("rank 2 ("));
  EXPECT_THAT(failure, HasSubstr("no more paper"));
}

TEST(RemotePes, AnotherBuildIsRefused) {
  ListeningHost host(1);
  const std::string failure = failure_on(
      {.count = 3}, small_machine(3, 2), host, [](Niu& niu, NativeClock& /*clock*/) { sleep_for_ever(niu); },
      [](ranks::Transport& transport) {
        remote::serve_pes(transport, transport.ranks().own == 2 ? "another" : "the same");
      });
  EXPECT_THAT(failure, HasSubstr("rank 2 ("));
  EXPECT_THAT(failure, HasSubstr("another build"));
}

TEST(RemotePes, ASilentRankIsNamed) {
  const RanksChoice choice{.count = 3, .times = kShort};
  ListeningHost host(1);
  const std::string failure =
      failure_on(choice, small_machine(3, 2), host, endless(), [&](ranks::Transport& transport) {
        if (transport.ranks().own == 1) return;  // as a process that is killed
        remote::serve_pes(transport, "the same", choice.times);
      });
  EXPECT_THAT(failure, HasSubstr("rank 1"));
  EXPECT_THAT(failure, HasSubstr("counts as lost"));
}

// Before the set-up has come, between that and the start, and as words come.
TEST(RemotePes, ALostConnectionIsNamedWhereverItIsLost) {
  const RanksChoice choice{.count = 4, .times = kShort};
  for (const unsigned messages : {0U, 1U, 2U, 3U, 30U}) {
    register_native_engine(endless());
    const auto ends = with_ranks(
        choice,
        [](remote::PeRanks& others) {
          MachineSetup setup = small_machine(3, 2);
          setup.ranks = &others;
          Machine machine(setup, empty_image());
          ListeningHost host(1);
          machine.run(host);
        },
        [&](ranks::Transport& transport) {
          if (transport.ranks().own != 2) return remote::serve_pes(transport, "the same", choice.times);
          unsigned received = 0;
          CutTransport cut(transport, [&](const ranks::Message&) { return received++ == messages; });
          remote::serve_pes(cut, "the same", choice.times);
        });
    EXPECT_THAT(ends[0], HasSubstr("rank 2 (")) << messages;
    EXPECT_THAT(ends[0], HasSubstr("is silent and counts as lost"));
    EXPECT_EQ(ends[1], "");
    EXPECT_EQ(ends[2], "rank 0 is silent and counts as lost");
    EXPECT_EQ(ends[3], "");
  }
}

TEST(RemotePes, AllEndWhereRankZeroIsLost) {
  register_native_engine(endless());
  const auto ends = ranks::run_as_threads(3, {}, [](ranks::Transport& transport) {
    if (transport.ranks().own != 0) return remote::serve_pes(transport, "the same", kShort);
    remote::PeRanks others(transport, remote::Placing::block, "the same", kShort);
    MachineSetup setup = small_machine(3, 2);
    setup.ranks = &others;
    Machine machine(setup, empty_image());
  });
  EXPECT_EQ(ends[0], "");
  for (const unsigned rank : {1U, 2U}) EXPECT_THAT(ends[rank], HasSubstr("rank 0 is silent and counts as lost"));
}

TEST(RemotePes, DoTheSameWhereARankIsSlow) {
  constexpr std::uint64_t kRecords = 6 * 10;
  const NativeProgram program = wanderers(10, 6, 160);
  CountingHost host(kRecords);
  const MachineOutcome expected = run(small_machine(3, 2), host, program);
  register_native_engine(program);
  const auto ends = with_ranks(
      {.count = 3},
      [&](remote::PeRanks& others) {
        MachineSetup setup = small_machine(3, 2);
        setup.ranks = &others;
        CountingHost again(kRecords);
        Machine machine(setup, empty_image());
        machine.run(again);
        EXPECT_EQ(exact(machine.figures()), expected.figures);
      },
      [](ranks::Transport& transport) {
        SlowTransport slow(transport, transport.ranks().own == 2 ? 2000us : 0us);
        remote::serve_pes(slow, "the same");
      });
  for (const std::string& end : ends) EXPECT_EQ(end, "");
}

}  // namespace
}  // namespace torolux::test
