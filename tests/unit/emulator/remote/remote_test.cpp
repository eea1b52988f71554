// SPDX-License-Identifier: MIT
// Proves: a machine whose PEs run on other ranks does what it does in one process, event for event and figure for
// figure, whatever the number of ranks, the placing and the delays of messages.
#include <gmock/gmock.h>

#include <chrono>

#include "tests/unit/emulator/remote/remote_support.hpp"

namespace torolux::test {
namespace {

using remote::Placing;
using std::chrono_literals::operator""us;
using testing::HasSubstr;

/// All that the figures tell, times of this computer apart.
std::string all_of(const MachineOutcome& outcome) {
  std::string text = outcome.figures;
  const auto add = [&text](const auto& values) {
    for (const auto value : values) text += std::to_string(value) + " ";
  };
  for (const Heard& heard : outcome.heard)
    text += std::to_string(heard.time) + ":" + std::to_string(heard.source) + " ";
  for (const StageFigures& stage : outcome.raw.stages) text += stage.name + "\n" + exact(stage.figures);
  for (const PeFigures& pe : outcome.raw.pes) {
    add(pe.waits);
    add(pe.phase_cycles);
    add(std::array<std::uint64_t, 4>{pe.idle_at_end, pe.copy_out_cycles, pe.copy_in_cycles, pe.halted ? 1U : 0U});
  }
  for (const TimeSlice& slice : outcome.raw.time_line.slices) text += std::to_string(slice.load) + " ";
  return text;
}

/// Small queues and slots, so that PEs wait for all that there is to wait for.
MachineSetup wandering_machine() {
  MachineSetup setup = small_machine(3, 2);
  setup.description.torus.send_queue_packets = 2;
  return setup;
}

NativeProgram wandering() {
  return wanderers(25, 6, 160);
}
constexpr std::uint64_t kWanderers = 6 * 25;

std::string alone() {
  CountingHost host(kWanderers);
  return all_of(run(wandering_machine(), host, wandering()));
}

std::string wander_on_ranks(const RanksChoice& choice) {
  CountingHost host(kWanderers);
  return all_of(run_on(choice, wandering_machine(), host, wandering()));
}

TEST(RemotePes, DoTheSameOnAnyNumberOfRanks) {
  const std::string expected = alone();
  for (const unsigned ranks : {2U, 3U, 5U}) EXPECT_EQ(wander_on_ranks({.count = ranks}), expected) << ranks;
}

TEST(RemotePes, DoTheSameWhereverTheyArePlaced) {
  const std::string expected = alone();
  for (const Placing placing : {Placing::cyclic, Placing::random})
    EXPECT_EQ(wander_on_ranks({.count = 3, .placing = placing}), expected) << static_cast<int>(placing);
}

TEST(RemotePes, DoTheSameHoweverLateMessagesAre) {
  const std::string expected = alone();
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    EXPECT_EQ(wander_on_ranks({.count = 3, .placing = Placing::cyclic, .delays = {seed, 2000us}}), expected) << seed;
  }
}

TEST(RemotePes, DoTheSameWithMoreRanksThanPes) {
  const std::string expected = alone();
  EXPECT_EQ(wander_on_ranks({.count = 9, .placing = Placing::random}), expected);
  EXPECT_EQ(wander_on_ranks({.count = 9}), expected);
}

TEST(RemotePes, GatherAsInOneProcess) {
  const NativeProgram program = gatherers(25, 6, 4000, 8);
  CountingHost host(kWanderers);
  const std::string expected = all_of(run(wandering_machine(), host, program));
  for (const std::uint64_t seed : {0U, 1U}) {
    CountingHost again(kWanderers);
    const RanksChoice choice{.count = 3, .placing = Placing::random, .delays = {seed, 500us * seed}};
    EXPECT_EQ(all_of(run_on(choice, wandering_machine(), again, program)), expected) << seed;
  }
}

TEST(RemotePes, EndWhereTheRunIsCut) {
  MachineSetup setup = wandering_machine();
  setup.until = 40'000;
  CountingHost host(kWanderers);
  const MachineOutcome expected = run(setup, host, wandering());
  EXPECT_TRUE(expected.raw.stopped);
  CountingHost again(kWanderers);
  EXPECT_EQ(all_of(run_on({.count = 3}, setup, again, wandering())), all_of(expected));
}

/// More packets for one PE than its rings hold, and more commands than may be under way.
TEST(RemotePes, WaitForRoomAsInOneProcess) {
  constexpr std::uint32_t kEach = 200;
  const NativeProgram program = [](Niu& niu, NativeClock& clock) {
    set_test_slots(niu, niu.pe() == 0 ? 2048 : 0);
    if (niu.pe() == 0) {
      niu.gather(1'000'000, 4096);
      std::uint32_t records = 0;
      while (records < 5 * kEach) {
        for (const auto* arrival = &niu.receive(); arrival->kind != ArrivalKind::none; arrival = &niu.receive_more())
          records += arrival->count;
      }
      niu.send(static_cast<protocol::MessageKind>(kDone), records);
    } else {
      for (std::uint32_t i = 0; i < kEach; ++i) {
        record(niu, i % kOwnSlots) = {};
        send_one(niu, 0, static_cast<std::uint16_t>(i % kOwnSlots));
      }
      for (std::uint32_t i = 0; i < 2000; ++i) set_test_slots(niu, 0);
    }
    clock.spend(1);
    sleep_for_ever(niu);
  };
  MachineSetup setup = small_machine(3, 2);
  setup.description.torus.send_queue_packets = 256;
  ListeningHost host(1);
  const std::string expected = all_of(run(setup, host, program));
  for (const unsigned ranks : {2U, 4U}) {
    ListeningHost again(1);
    EXPECT_EQ(all_of(run_on({.count = ranks, .delays = {ranks, 200us}}, setup, again, program)), expected) << ranks;
  }
}

TEST(RemotePes, ShowTheirMemoryAfterTheEnd) {
  register_native_engine([](Niu& niu, NativeClock& /*clock*/) {
    set_test_slots(niu, 16);
    record(niu, 3) = {niu.pe(), 77, 0, 0, {}};
    niu.send(static_cast<protocol::MessageKind>(kDone));
    sleep_for_ever(niu);
  });
  with_ranks({.count = 3}, [](remote::PeRanks& others) {
    MachineSetup setup = small_machine(3, 2);
    setup.ranks = &others;
    ListeningHost host(6);
    Machine machine(setup, empty_image());
    machine.run(host);
    const std::uint32_t stores = empty_image().stores_begin - protocol::kLocalMemoryBase;
    for (const unsigned pe : {1U, 5U}) {
      TestRecord seen{};
      std::memcpy(&seen, machine.local_memory(pe).subspan(stores + 3 * sizeof seen).data(), sizeof seen);
      EXPECT_EQ(seen.source, pe);
      EXPECT_EQ(seen.number, 77U);
    }
  });
}

TEST(Placing, GivesEachPeARankBesideTheFirst) {
  for (const Placing placing : {Placing::block, Placing::cyclic, Placing::random}) {
    for (const unsigned ranks : {2U, 3U, 8U}) {
      std::vector<unsigned> count(ranks);
      for (const unsigned rank : remote::place_pes(16, ranks, placing)) ++count.at(rank);
      EXPECT_EQ(count[0], 0U);
      if (placing == Placing::random) continue;
      EXPECT_LE(*std::max_element(count.begin() + 1, count.end()) - *std::min_element(count.begin() + 1, count.end()),
                1U);
    }
  }
}

/// A PE that fails, as its program says itself.
TEST(RemotePes, TellOfAFaultInTheSameWords) {
  const NativeProgram program = [](Niu& niu, NativeClock& /*clock*/) {
    if (niu.pe() == 4) {
      set_test_slots(niu, 16);
      send_one(niu, 77, 0);
    }
    sleep_for_ever(niu);
  };
  ListeningHost host(1);
  const std::string expected = failure_of(small_machine(3, 2), host, program);
  EXPECT_THAT(expected, HasSubstr("PE 4"));
  ListeningHost again(1);
  EXPECT_EQ(failure_on({.count = 3}, small_machine(3, 2), again, program), expected);
}

TEST(RemotePes, WhatDoesNotGoWithRanksIsRefused) {
  ListeningHost host(1);
  MachineSetup setup = small_machine(2, 1);
  setup.debugging.qemu_pes = {1};
  EXPECT_THAT(failure_on({}, setup, host, wandering()), HasSubstr("leave out --ranks, or mpirun"));
}

}  // namespace
}  // namespace torolux::test
