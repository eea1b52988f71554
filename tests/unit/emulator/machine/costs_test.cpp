// SPDX-License-Identifier: MIT
// What host, NIUs, signals and bus take, by hand, on machines of one or two PEs; and that nothing gets stuck where each
// of them has as little room as there may be.
#include <gtest/gtest.h>

#include "emulator/errors.hpp"
#include "emulator/host/host_clock.hpp"
#include "emulator/machine/network_memory.hpp"
#include "tests/support/least_queues.hpp"
#include "tests/unit/emulator/machine/wanderers.hpp"

namespace torolux::test {
namespace {

using protocol::MessageKind;

/// Each HINT costs one cycle.
NativeOptions short_hints() {
  NativeOptions options;
  options.cycles_per_hint = 1;
  return options;
}

// ---- Host ----

TEST(HostClock, KeepsWhatIsLeftOfACycle) {
  MachineDescription machine;
  machine.processor.clock_hertz = 100e6;
  machine.host.clock_hertz = 300e6;
  machine.host.cycles[static_cast<std::size_t>(HostWork::entry)] = 1;
  HostClock clock(machine);
  for (int i = 0; i < 4; ++i) clock.work(HostWork::entry, 1);
  EXPECT_EQ(clock.now(), 2U) << "4 / 3 of a cycle, rounded up";
  for (int i = 0; i < 2; ++i) clock.work(HostWork::entry, 1);
  EXPECT_EQ(clock.now(), 2U) << "6 / 3";
  clock.wait_until(10);
  clock.work(HostWork::entry, 1);
  EXPECT_EQ(clock.now(), 11U);
  EXPECT_EQ(clock.busy(11), 3U);
  EXPECT_EQ(clock.busy(20), 3U) << "it has nothing to do after 11";
  EXPECT_EQ(clock.own_cycles()[static_cast<std::size_t>(HostWork::entry)], 7U);
}

// Not a clock that begins anew, and events in the past.
TEST(HostClock, BeyondWhatTimeHoldsEndsTheRun) {
  MachineDescription machine;
  machine.host.clock_hertz = 1;
  machine.host.cost_factor = 1000;
  HostClock clock(machine);
  const auto work = [&] { clock.work(HostWork::message, 1000); };
  const auto until_it_ends = [&] {
    for (Cycles before = 0; before <= clock.now(); work()) before = clock.now();
  };
  EXPECT_THROW(until_it_ends(), MachineFailure);
  EXPECT_GT(clock.now(), Cycles{1} << 61U);
}

TEST(HostClock, ACostFactorMultipliesAndNoneIsIdeal) {
  for (const std::uint32_t factor : {0U, 1U, 100U}) {
    MachineDescription machine;
    machine.host.cost_factor = factor;
    HostClock clock(machine);
    clock.work(HostWork::message, 3);
    EXPECT_EQ(clock.now(), 150U * factor);
    EXPECT_EQ(clock.items()[0], 3U);
  }
  MachineDescription machine;
  machine.ideal.host = true;
  HostClock clock(machine);
  clock.work(HostWork::camera_ray, 1'000'000);
  EXPECT_EQ(clock.now(), 0U);
}

/// The clock of PE 0 after it has received `messages` messages of so many bytes each, sent at the start.
std::vector<Cycles> receive_times(const MachineSetup& setup, unsigned messages, std::size_t bytes) {
  ListeningHost host(messages);
  host.at_start = [&](HostPort& port) {
    const std::vector<std::byte> contents(bytes);
    for (unsigned i = 0; i < messages; ++i) port.send_message(0, kGo, contents);
  };
  const MachineOutcome outcome = run(
      setup, host,
      [&](Niu& niu, NativeClock& clock) {
        for (unsigned i = 0; i < messages; ++i) {
          niu.receive();
          niu.send(static_cast<MessageKind>(kText), clock.cycles());
        }
        sleep_for_ever(niu);
      },
      short_hints());
  std::vector<Cycles> times;
  for (const Heard& heard : outcome.heard) times.push_back(heard.as<Cycles>());
  return times;
}

TEST(Costs, AMessageOfTheHost) {
  // Made in 1500 + 15 ceil(100 / 64) cycles of the host: 51 of the PEs. The bus sees the request 4 later, and takes
  // 4 + ceil(108 / 8) = 18. The processor, asleep, is woken then, and its HINT ends once 108 bytes are copied: 14.
  MachineSetup setup = small_machine(1, 1);
  EXPECT_EQ(receive_times(setup, 1, 100).at(0), 51U + 4 + 18 + 14);
  setup.description.niu.bytes_per_cycle = 1;
  EXPECT_EQ(receive_times(setup, 1, 100).at(0), 51U + 4 + 18 + 108);
  setup.description.ideal.niu = true;
  EXPECT_EQ(receive_times(setup, 1, 100).at(0), 51U + 4 + 18);
  setup.description.ideal.signals = true;
  EXPECT_EQ(receive_times(setup, 1, 100).at(0), 51U + 18);
  setup.description.ideal.host = true;
  EXPECT_EQ(receive_times(setup, 1, 100).at(0), 18U);
}

TEST(Costs, AControlBufferThatHasBecomeFreeIsSeenLater) {
  // One buffer, and a host that takes no time: the second message goes once the host knows that the first has been
  // taken. That is so when its HINT has ended (18 + 4 + 14), a cycle later at the NIU, 4 at the host, 4 at the arbiter.
  // A cycle before, that has seen the PE's answer: HINT 1, copy ceil(16 / 8) = 2, queue 1, 4; it takes 4 + 2.
  MachineSetup setup = small_machine(1, 1);
  setup.description.bus.control_buffers = 1;
  setup.description.ideal.host = true;
  const std::vector<Cycles> times = receive_times(setup, 2, 100);
  EXPECT_EQ(times.at(0), 4U + 18 + 14);
  EXPECT_EQ(times.at(1), times.at(0) + 8 + 6 + 18 + 14);
  setup.description.ideal.signals = true;
  const std::vector<Cycles> ideal = receive_times(setup, 2, 100);
  // Ahead of the answer.
  EXPECT_EQ(ideal.at(1), ideal.at(0) + 1 + 18 + 14);
}

TEST(Costs, TheHostAsksForRecordSlots) {
  // Asked at 0, at the NIU after 4, granted after 8, seen by the arbiter after 12; 4 + ceil((8 + 128) / 8) = 21; copied
  // in 16.
  MachineSetup setup = small_machine(1, 1);
  setup.description.ideal.host = true;
  const auto time = [&] {
    ListeningHost host(1);
    host.at_start = [](HostPort& port) {
      const std::array<TestRecord, 2> records{};
      port.send_records(0, std::as_bytes(std::span(records)), sizeof(TestRecord));
    };
    const MachineOutcome outcome = run(
        setup, host,
        [](Niu& niu, NativeClock& clock) {
          set_test_slots(niu, 16);
          niu.receive();
          niu.send(static_cast<MessageKind>(kText), clock.cycles());
          sleep_for_ever(niu);
        },
        short_hints());
    return outcome.heard.at(0).as<Cycles>();
  };
  EXPECT_EQ(time(), 12U + 21 + 16);
  setup.description.ideal.niu = true;
  EXPECT_EQ(time(), 12U + 21);
  setup.description.ideal.signals = true;
  // The slots are there at cycle 2 only: the HINT that sets them ends at 1.
  EXPECT_EQ(time(), 2U + 21);
}

// ---- NIU ----

TEST(Costs, ASendersProcessorWaitsForTheCopyBeforeOnly) {
  // 16 records of 64 bytes: 128 cycles. The first HINT ends at once, the second when the first copy has ended.
  ListeningHost host(3);
  const MachineOutcome outcome = run(
      small_machine(2, 1), host,
      [](Niu& niu, NativeClock& clock) {
        set_test_slots(niu, 64);
        if (niu.pe() == 0) {
          std::array<std::uint16_t, 16> slots{};
          for (std::uint16_t i = 0; i < 16; ++i) slots[i] = i;
          const Cycles begin = clock.cycles();
          niu.send_records(1, slots);
          const Cycles first = clock.cycles() - begin;
          niu.send_records(1, slots);
          const Cycles second = clock.cycles() - begin;
          niu.send(static_cast<MessageKind>(kText), std::array<Cycles, 2>{first, second});
        } else {
          for (int i = 0; i < 2; ++i) {
            niu.receive();
            niu.send(static_cast<MessageKind>(kDone), clock.cycles());
          }
        }
        sleep_for_ever(niu);
      },
      short_hints());
  std::vector<Cycles> arrived;
  for (const Heard& heard : outcome.heard) {
    if (heard.source == 0) {
      EXPECT_EQ((heard.as<std::array<Cycles, 2>>()), (std::array<Cycles, 2>{1, 1 + 128}));
    } else {
      arrived.push_back(heard.as<Cycles>());
    }
  }
  // The HINT that set the slots ended at 1, the first send's at 2. It is copied by 130, in the queue at 131; 2 hops of
  // 4 and 64 other flits: 203; copied by 331. The second is one copy later all the way.
  EXPECT_EQ(arrived, (std::vector<Cycles>{331, 331 + 128}));
  const PeFigures& sender = outcome.raw.pes[0];
  EXPECT_EQ(sender.copy_out_cycles, 2U * 128 + 3) << "and a message of 8 + 16 bytes";
  EXPECT_EQ(sender.waits[static_cast<std::size_t>(WaitReason::copy)], 2U * 127)
      << "of the second packet, and of the message";
  EXPECT_EQ(outcome.raw.pes[1].copy_in_cycles, 2U * 128);
  EXPECT_EQ(outcome.raw.pes[1].receive_buffers_high_water, 2U)
      << "the second packet needs its own from when its head leaves the torus";
}

TEST(Costs, NoMoreReceiveBuffersThanThereAre) {
  for (const std::uint32_t buffers : {1U, 2U}) {
    MachineSetup setup = small_machine(3, 3);
    setup.description.niu.receive_packets = buffers;
    setup.description.niu.bytes_per_cycle = 1;
    CountingHost host(9 * 60);
    const MachineOutcome outcome = run(setup, host, wanderers(60, 12, 64));
    std::uint32_t most = 0;
    for (const PeFigures& pe : outcome.raw.pes) most = std::max(most, pe.receive_buffers_high_water);
    EXPECT_EQ(most, buffers);
  }
}

TEST(NetworkMemory, IsThatOfQueuesAndBuffers) {
  MachineDescription machine;
  machine.torus.send_queue_packets = 3;
  machine.torus.buffer_packets = 2;
  machine.niu.receive_packets = 4;
  machine.bus.send_queue_messages = 5;
  machine.bus.control_buffers = 6;
  const NetworkMemory memory = network_memory(machine);
  EXPECT_EQ(memory.niu(), (3 + 4 + 1 + 1) * 1040U + (5 + 6) * 1032U);
  EXPECT_EQ(memory.router(), (4 * 2 + 4) * 1040U);
}

// ---- Bus ----

TEST(Costs, RequestsOfOneCycleAreServedInTurn) {
  // All PEs send at the same clock, one after the other at their first, third and so on. The host, whose queue comes
  // first in the circle, has nothing. Whoever has had the bus comes last, so all have one turn before any has two.
  constexpr unsigned kPes = 4;
  ListeningHost host(3 * kPes);
  MachineSetup setup = small_machine(kPes, 1);
  setup.description.ideal.host = true;
  const MachineOutcome outcome = run(
      setup, host,
      [](Niu& niu, NativeClock& /*clock*/) {
        for (std::uint32_t i = 0; i < 3; ++i) niu.send(static_cast<MessageKind>(kText), i);
        sleep_for_ever(niu);
      },
      short_hints());
  ASSERT_EQ(outcome.heard.size(), 3 * kPes);
  for (unsigned i = 0; i < 3 * kPes; ++i) {
    EXPECT_EQ(outcome.heard[i].source, i % kPes) << i;
    EXPECT_EQ(outcome.heard[i].as<std::uint32_t>(), i / kPes) << i;
    // HINT 1, copy 2, queue 1, seen 4 later; then 4 + 2 each, without a gap: a request that stays up needs no signal.
    EXPECT_EQ(outcome.heard[i].time, 8U + 6 * (i + 1)) << i;
  }
  const BusFigures& bus = outcome.raw.bus;
  EXPECT_EQ(bus.arbitration_cycles, 12U * 4);
  EXPECT_EQ(bus.data_cycles, 12U * 2);
  EXPECT_EQ(bus.users[static_cast<std::size_t>(BusUser::queue)].bytes, 12U * 12);
  EXPECT_EQ(bus.kinds[static_cast<std::size_t>(BusKind::answers)].transfers, 12U);
  EXPECT_EQ(bus.from_pe[2].cycles, 3U * 6);
}

TEST(Costs, AFullFrameBufferControllerIsSeenToBeFreeLater) {
  // One place, one pixel of 100 cycles in each message; then a message to the host.
  MachineSetup setup = small_machine(1, 1);
  setup.frame_width = setup.frame_height = 1;
  setup.description.ideal.host = true;
  setup.description.frame_buffer.queue_messages = 1;
  setup.description.frame_buffer.cycles_per_pixel = 100;
  const auto time = [&] {
    ListeningHost host(1);
    return run(
               setup, host,
               [](Niu& niu, NativeClock& /*clock*/) {
                 const std::array<protocol::PixelAdd, 1> add{{{{1, 2, 3}, 0, protocol::Plane::colour}}};
                 for (int i = 0; i < 3; ++i) {
                   niu.send_message(protocol::kFrameBuffer,
                                    static_cast<std::uint16_t>(protocol::MachineMessage::pixels),
                                    std::as_bytes(std::span(add)));
                 }
                 niu.send(static_cast<MessageKind>(kDone));
                 sleep_for_ever(niu);
               },
               short_hints())
        .heard.at(0)
        .time;
  };
  // HINT 1, copy 5, queue 1, seen 4: 11. A transfer is 4 + 5, and its place is seen to be free 100 + 4 later. The last
  // pixels go at 11 + 2 (9 + 104), and behind them the message: 4 + 1.
  EXPECT_EQ(time(), 11U + 2 * (9 + 104) + 9 + 5);
  setup.description.ideal.signals = true;
  EXPECT_EQ(time(), 7U + 2 * (9 + 100) + 9 + 5);
}

// ---- As little room as there may be ----

MachineSetup smallest_machine() {
  MachineSetup setup = small_machine(4, 3);
  take_least_queues(setup.description);
  return setup;
}

TEST(Costs, TheSmallestMachineEndsAndIsTheSameWhateverTheThreadsDo) {
  // Two slots for records that may all be underway to one PE: most are diverted, and come back by the host.
  for (const std::uint32_t width : {1U, 64U}) {
    MachineSetup setup = smallest_machine();
    setup.description.niu.bytes_per_cycle = width;
    expect_same_runs(setup, wanderers(40, 12, 2), 12 * 40, 3);
  }
}

TEST(Costs, HostAndBusCyclesAddUp) {
  CountingHost host(12 * 40);
  const MachineFigures figures = run(smallest_machine(), host, wanderers(40, 12, 2)).raw;
  std::uint64_t transfers = 0;
  Cycles cycles = 0;
  for (const BusTraffic& kind : figures.bus.kinds) {
    transfers += kind.transfers;
    cycles += kind.cycles;
  }
  EXPECT_EQ(transfers, figures.bus.transfers);
  EXPECT_EQ(cycles, figures.bus.busy_cycles());
  EXPECT_LE(figures.bus.busy_cycles(), figures.now);
  EXPECT_GT(figures.bus.kinds[static_cast<std::size_t>(BusKind::diverted)].transfers, 0U);
  EXPECT_EQ(figures.bus.kinds[static_cast<std::size_t>(BusKind::diverted)].bytes,
            figures.bus.kinds[static_cast<std::size_t>(BusKind::records)].bytes);
  EXPECT_GT(figures.host.busy_cycles, 0U);
  EXPECT_LE(figures.host.busy_cycles, figures.now);
  std::uint64_t own = 0;
  for (const std::uint64_t work : figures.host.own_cycles) own += work;
  EXPECT_GE(figures.host.busy_cycles * 30, own) << "rounded up each time that it has nothing left to do";
}

}  // namespace
}  // namespace torolux::test
