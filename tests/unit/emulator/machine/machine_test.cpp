// SPDX-License-Identifier: MIT
// Whole machines with native programs: exact latencies, order, slots, diversion, determinism, deadlocks, faults.
#include "emulator/machine/machine.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emulator/errors.hpp"
#include "firmware/protocol/random.hpp"
#include "tests/unit/emulator/machine/wanderers.hpp"

namespace torolux::test {

namespace {

using testing::HasSubstr;

/// PE 0 sends one record to PE `to`, which answers with its clock.
Cycles latency_to(const MachineSetup& setup, unsigned to) {
  ListeningHost host(2);
  const auto program = [&](Niu& niu, NativeClock& clock) {
    set_test_slots(niu, 16);
    if (niu.pe() == 0) {
      clock.spend(10'000 - clock.cycles() - 1);
      record(niu, 0) = {};
      send_one(niu, to, 0);
      niu.send(static_cast<protocol::MessageKind>(kText), clock.cycles());
    }
    if (niu.pe() == to) {
      niu.receive();
      niu.send(static_cast<protocol::MessageKind>(kText), clock.cycles());
    }
    sleep_for_ever(niu);
  };
  NativeOptions options;
  options.cycles_per_hint = 1;
  const MachineOutcome outcome = run(setup, host, program, options);
  // The sender's clock after its send, the receiver's after its receive; each HINT costs one cycle.
  std::uint64_t sent = 0;
  std::uint64_t received = 0;
  for (const Heard& heard : outcome.heard) (heard.source == 0 && sent == 0 ? sent : received) = heard.as<Cycles>();
  return received - sent;
}

TEST(Machine, ZeroLoadLatencyIsExact) {
  // By hand: 1 cycle into the queue, (hops + 1) * (router 3 + link 1), and the packet's other flits:
  // (16 + 64) / 16 = 5 flits, so 4. Hops on a 4x4 torus: PE 1: 1, PE 2: 2, PE 3: 1 (around), PE 5: 2, PE 10: 4.
  // The record is copied into the NIU and out of the other one: 64 bytes, 8 in a cycle, so 8 cycles each.
  MachineSetup setup = small_machine(4, 4);
  for (const Cycles copies : {16U, 0U}) {
    EXPECT_EQ(latency_to(setup, 1), 1U + 2 * 4 + 4 + copies);
    EXPECT_EQ(latency_to(setup, 2), 1U + 3 * 4 + 4 + copies);
    EXPECT_EQ(latency_to(setup, 3), 1U + 2 * 4 + 4 + copies);
    EXPECT_EQ(latency_to(setup, 5), 1U + 3 * 4 + 4 + copies);
    EXPECT_EQ(latency_to(setup, 10), 1U + 5 * 4 + 4 + copies);
    setup.description.ideal.niu = true;
  }
}

TEST(Machine, LatencyFollowsTheDescription) {
  MachineSetup setup = small_machine(4, 4);
  setup.description.torus.router_cycles = 7;
  setup.description.torus.link_cycles = 5;
  setup.description.torus.flit_bytes = 8;
  setup.description.niu.bytes_per_cycle = 3;
  EXPECT_EQ(latency_to(setup, 10), 1U + 5 * 12 + 9 + 2 * 22);
}

TEST(Machine, BusAndHostTimesAreExact) {
  // PE: HINT 1 ends at cycle 1, copy ceil((8 + 4) / 8) = 2 cycles, in the queue 1 later at 4, the arbiter sees that 4
  // cycles later, transfer 4 + ceil((8 + 4) / 8) = 6 cycles. To the host a message is 1500 cycles of its own, its one
  // cache line 15: at 30 to one 50.5, so it is seen after 51.
  ListeningHost host(1);
  NativeOptions options;
  options.cycles_per_hint = 1;
  const MachineOutcome outcome = run(
      small_machine(1, 1), host,
      [](Niu& niu, NativeClock& /*clock*/) {
        niu.send(static_cast<protocol::MessageKind>(kText), std::uint32_t{42});
        sleep_for_ever(niu);
      },
      options);
  ASSERT_EQ(outcome.heard.size(), 1U);
  EXPECT_EQ(outcome.heard[0].time, 4U + 4 + 6 + 51);
  EXPECT_EQ(outcome.heard[0].as<std::uint32_t>(), 42U);
}

TEST(Machine, PacketsOfAPairArriveInOrder) {
  // Delays and link errors do not change it. Slots for all records: diversion gives the order up, by design.
  constexpr std::uint32_t kPackets = 200;
  ListeningHost host(16);
  MachineSetup setup = small_machine(4, 4);
  setup.local_memory_bytes = 512U * 1024U;
  setup.description.jitter = {.seed = 1, .cycles = 30};
  setup.description.torus.link_error_rate = 0.1;
  const MachineOutcome outcome = run(setup, host, [](Niu& niu, NativeClock& /*clock*/) {
    set_test_slots(niu, niu.pe() == 0 ? 15 * kPackets : 0);
    std::vector<std::uint32_t> next(16, 0);
    for (std::uint32_t i = 0; i < kPackets * (niu.pe() == 0 ? 15 : 1); ++i) {
      if (niu.pe() != 0) {
        const auto slot = static_cast<std::uint16_t>(i % kOwnSlots);
        record(niu, slot) = {niu.pe(), i, 0, 0, {}};
        send_one(niu, 0, slot);
        continue;
      }
      const auto& arrival = niu.receive();
      const TestRecord& got = record(niu, arrival.slots[0]);
      EXPECT_EQ(arrival.source, got.source);
      EXPECT_EQ(got.number, next[got.source]++);
      niu.release(arrival.slots[0]);
    }
    niu.send(static_cast<protocol::MessageKind>(kDone));
    sleep_for_ever(niu);
  });
  EXPECT_EQ(outcome.raw.pes[0].packets_delivered, 15 * kPackets);
  EXPECT_EQ(outcome.raw.pes[0].records_diverted, 0U);
  EXPECT_GT(outcome.raw.link_retries, 100U);
}

TEST(Machine, EveryRecordComesHome) {
  for (const auto& [columns, rows] : {std::pair(1U, 1U), {1U, 5U}, {2U, 3U}, {4U, 4U}}) {
    CountingHost host(std::uint64_t{columns} * rows * 100);
    const MachineOutcome outcome = run(small_machine(columns, rows), host, wanderers(100, 20, 4096 / 8));
    std::uint64_t sent = 0;
    std::uint64_t delivered = 0;
    for (const PeFigures& pe : outcome.raw.pes) {
      sent += pe.packets_sent;
      delivered += pe.packets_delivered;
      EXPECT_EQ(pe.busy_cycles + pe.idle_cycles(), outcome.raw.now);
    }
    EXPECT_EQ(host.home(), std::uint64_t{columns} * rows * 100);
    EXPECT_EQ(sent, delivered);
    EXPECT_EQ(sent, std::uint64_t{columns} * rows * 100 * 20);
  }
}

TEST(Machine, DivertedRecordsAllComeBack) {
  MachineSetup setup = small_machine(3, 3);
  CountingHost host(9 * 150);
  const MachineOutcome outcome = run(setup, host, wanderers(150, 12, 2));
  std::uint64_t diverted = 0;
  for (const PeFigures& pe : outcome.raw.pes) {
    diverted += pe.records_diverted;
    EXPECT_LE(pe.record_slots_high_water, 2U);
  }
  EXPECT_EQ(host.home(), 9U * 150);
  EXPECT_GT(diverted, 100U);
}

TEST(Machine, SameRunWhateverTheThreadsDo) {
  MachineSetup setup = small_machine(3, 3);
  setup.description.torus.send_queue_packets = 1;
  setup.description.bus.send_queue_messages = 1;
  expect_same_runs(setup, wanderers(60, 12, 6), 9 * 60, 6);
}

TEST(Machine, MessagesOfOneQueueKeepTheirOrderAndReachHostAndFrameBuffer) {
  MachineSetup setup = small_machine(2, 2);
  setup.frame_width = 4;
  setup.frame_height = 2;
  setup.description.frame_buffer.queue_messages = 1;
  setup.description.frame_buffer.cycles_per_pixel = 100;
  ListeningHost host(4);
  register_native_engine([](Niu& niu, NativeClock& /*clock*/) {
    std::array<protocol::PixelAdd, 8> pixels{};
    for (std::uint32_t i = 0; i < 8; ++i)
      pixels[i] = {{i, -2 * std::int64_t{i}, std::int64_t{1} << 40U}, i, protocol::Plane::colour};
    for (int i = 0; i < 5; ++i) {
      niu.send_message(protocol::kFrameBuffer, static_cast<std::uint16_t>(protocol::MachineMessage::pixels),
                       std::as_bytes(std::span(pixels)));
    }
    niu.send(static_cast<protocol::MessageKind>(kDone));
    sleep_for_ever(niu);
  });
  const Image image = empty_image();
  Machine machine(setup, image);
  machine.run(host);
  // All pixels went ahead of the last message: the bus took them only as the controller had a place.
  EXPECT_GT(host.heard[0].time, 4 * 100U * 8);
  const FrameBuffer& frame = machine.frame_buffer();
  const auto& sums = frame.plane(protocol::Plane::colour);
  ASSERT_EQ(sums.size(), 8U);
  for (std::int64_t i = 0; i < 8; ++i) {
    const std::array<std::int64_t, 3> expected = {20 * i, -40 * i, 20 * (std::int64_t{1} << 40U)};
    EXPECT_EQ(sums[static_cast<std::size_t>(i)], expected);
  }
  EXPECT_EQ(machine.figures().pixels_added, 160U);
  EXPECT_EQ(machine.figures().frame_buffer_busy_cycles, 16000U);
}

/// One PE adds 1, 2, 3 to pixel 1 of a plane, of a frame buffer of 2 x 1 pixels with these layers.
FrameBuffer frame_after_adding(protocol::Plane plane, std::uint32_t layers) {
  MachineSetup setup = small_machine(1, 1);
  setup.frame_width = 2;
  setup.frame_height = 1;
  setup.frame_layers = layers;
  ListeningHost host(1);
  register_native_engine([plane](Niu& niu, NativeClock& /*clock*/) {
    const std::array<protocol::PixelAdd, 1> add{{{{1, 2, 3}, 1, plane}}};
    niu.send_message(protocol::kFrameBuffer, static_cast<std::uint16_t>(protocol::MachineMessage::pixels),
                     std::as_bytes(std::span(add)));
    niu.send(static_cast<protocol::MessageKind>(kDone));
    sleep_for_ever(niu);
  });
  const Image image = empty_image();
  Machine machine(setup, image);
  machine.run(host);
  return machine.frame_buffer();
}

TEST(Machine, LayersHavePlanesOfTheirOwn) {
  using protocol::Plane;
  const std::uint32_t layers = protocol::plane_bit(Plane::depth) | protocol::plane_bit(Plane::cost);
  const FrameBuffer frame = frame_after_adding(Plane::cost, layers);
  EXPECT_EQ(frame.plane(Plane::cost), (std::vector<PixelSums>{{0, 0, 0}, {1, 2, 3}}));
  for (const Plane plane : {Plane::colour, Plane::depth}) {
    EXPECT_EQ(frame.plane(plane), (std::vector<PixelSums>{{0, 0, 0}, {0, 0, 0}}));
  }
  EXPECT_TRUE(frame.plane(Plane::normals).empty());
  for (const Plane plane : {Plane::normals, Plane{protocol::kPlanes}, Plane{0xFFFF'FFFFU}}) {
    EXPECT_THROW(frame_after_adding(plane, layers), MachineFailure) << "not asked for, or none at all";
  }
}

TEST(Machine, HostSendsInOrderAndHoldsBackWhatHasNoRoom) {
  // Far more messages and records than buffers and slots: the PE sees them all, in order, intact.
  constexpr std::uint32_t kCount = 300;
  ListeningHost host(2);
  host.at_start = [](HostPort& port) {
    for (std::uint32_t i = 0; i < kCount; ++i) {
      for (PeNumber pe = 0; pe < 2; ++pe) {
        const std::vector<std::uint32_t> words(1 + i % 200, i);
        port.send_message(pe, kGo, std::as_bytes(std::span(words)));
        const std::array<TestRecord, 3> records = {TestRecord{pe, 3 * i, 0, 0, {}}, TestRecord{pe, 3 * i + 1, 0, 0, {}},
                                                   TestRecord{pe, 3 * i + 2, 0, 0, {}}};
        port.send_records(pe, std::as_bytes(std::span(records)), sizeof(TestRecord));
      }
    }
    EXPECT_EQ(port.queued(0), 2U * kCount);
  };
  const MachineOutcome outcome = run(small_machine(2, 1), host, [](Niu& niu, NativeClock& clock) {
    set_test_slots(niu, 7);
    std::uint32_t messages = 0;
    std::uint32_t records = 0;
    while (messages < kCount || records < 3 * kCount) {
      const auto& arrival = niu.receive();
      clock.spend(500);
      EXPECT_EQ(arrival.source, protocol::kHost);
      if (arrival.kind == ArrivalKind::message) {
        EXPECT_EQ(niu.message_bytes().size(), 4 * (1 + messages % 200));
        EXPECT_EQ(niu.message_as<std::uint32_t>(), messages);
        ++messages;
      }
      const auto slots = arrival.slots;
      for (std::uint32_t i = 0; i < arrival.count; ++i) {
        EXPECT_EQ(record(niu, slots[i]).number, records++);
        niu.release(slots[i]);
      }
    }
    niu.send(static_cast<protocol::MessageKind>(kDone));
    sleep_for_ever(niu);
  });
  for (const PeFigures& pe : outcome.raw.pes) {
    EXPECT_LE(pe.record_slots_high_water, 7U);
    EXPECT_EQ(pe.records_diverted, 0U);
  }
}

TEST(Machine, DeadlockNamesWhoWaitsForWhat) {
  ListeningHost host(1);
  const std::string report =
      failure_of(small_machine(2, 1), host, [](Niu& niu, NativeClock& /*clock*/) { sleep_for_ever(niu); });
  EXPECT_THAT(report, HasSubstr("deadlock"));
  EXPECT_THAT(report, HasSubstr("waits for more messages"));
  EXPECT_THAT(report, HasSubstr("PE 1 (clock 200) waits to receive"));
}

TEST(Machine, AFinishedProgramWithMessagesLeftIsADeadlock) {
  ListeningHost host(0);
  host.at_start = [](HostPort& port) {
    for (int i = 0; i < 5; ++i) port.send_message(0, kGo, {});
  };
  const std::string report = failure_of(small_machine(1, 1), host, [](Niu& /*niu*/, NativeClock& /*clock*/) {});
  EXPECT_THAT(report, HasSubstr("has halted"));
  EXPECT_THAT(report, HasSubstr("from the host 3"));
}

TEST(Machine, FaultsNameThePe) {
  ListeningHost host(1);
  const MachineSetup setup = small_machine(2, 2);
  const auto only_pe_2 = [](auto action) {
    return [action](Niu& niu, NativeClock& clock) {
      if (niu.pe() == 2) action(niu, clock);
      sleep_for_ever(niu);
    };
  };
  EXPECT_THAT(
      failure_of(setup, host, only_pe_2([](Niu& niu, NativeClock&) { niu.fail(protocol::FaultCode::bad_record, 7); })),
      HasSubstr("PE 2: the program failed: code 7 (in pe.elf: bad record: number of waiting branches = 0), details 7, "
                "0, 0; see "
                "docs/errors.md"));
  EXPECT_THAT(failure_of(setup, host, only_pe_2([](Niu& niu, NativeClock&) {
                           niu.fail(protocol::FaultCode::trap, 5, 0x8000'0010U, 0x90U);
                         })),
              HasSubstr("PE 2: trap: load outside local memory at"));
  EXPECT_THAT(failure_of(setup, host, only_pe_2([](Niu& niu, NativeClock&) {
                           set_test_slots(niu, 4);
                           niu.release(kOwnSlots);
                           niu.receive();
                         })),
              HasSubstr("PE 2: record slot released that is not in use"));
  EXPECT_THAT(failure_of(setup, host, only_pe_2([](Niu& niu, NativeClock&) {
                           set_test_slots(niu, 4);
                           send_one(niu, 4, 0);
                         })),
              HasSubstr("PE 2: no such destination"));
  EXPECT_THAT(failure_of(setup, host, only_pe_2([](Niu& niu, NativeClock& clock) {
                           clock.spend(3'000'000'000);
                           niu.clock();
                         })),
              HasSubstr("endless loop"));
}

TEST(Machine, ProgressCanEndARun) {
  ListeningHost host(1);
  register_native_engine([](Niu& niu, NativeClock& clock) {
    for (;;) {
      clock.spend(100);
      niu.clock();
    }
  });
  const Image image = empty_image();
  Machine machine(small_machine(2, 1), image);
  int calls = 0;
  EXPECT_THROW(machine.run(host, [&](Cycles) { return ++calls < 3; }), Interrupted);
}

TEST(Machine, RefusesWhatCannotBe) {
  const Image image = empty_image();
  MachineSetup setup = small_machine(0, 4);
  EXPECT_THROW(Machine(setup, image), UsageError);
  setup = small_machine(1, 1);
  setup.local_memory_bytes = 1000;
  EXPECT_THROW(Machine(setup, image), UsageError);
  setup = small_machine(1, 1);
  setup.description.torus.send_queue_packets = 1000;
  EXPECT_THROW(Machine(setup, image), InputError);
}

}  // namespace

}  // namespace torolux::test
