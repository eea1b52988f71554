// SPDX-License-Identifier: MIT
// Broadcasts over the bus: all PEs hear at once, in one transfer, in the order of the host's sends, and only once each
// has a free control buffer; figures once; the same every time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/least_queues.hpp"
#include "tests/unit/emulator/machine/wanderers.hpp"

namespace torolux::test {
namespace {

using protocol::MessageKind;
using ::testing::HasSubstr;

NativeOptions short_hints() {
  NativeOptions options;
  options.cycles_per_hint = 1;
  return options;
}

/// A program that tells the clock after each of so many messages received, and spends a PE's `pause` before the first.
NativeProgram tell_times(unsigned messages, const std::vector<Cycles>& pauses) {
  return [=](Niu& niu, NativeClock& clock) {
    clock.spend(pauses.at(niu.pe()));
    for (unsigned i = 0; i < messages; ++i) {
      niu.receive();
      EXPECT_EQ(niu.message_as<std::uint32_t>(), i);
      niu.send(static_cast<MessageKind>(kText), clock.cycles());
    }
    sleep_for_ever(niu);
  };
}

/// By PE, the clocks that it has told.
std::vector<std::vector<Cycles>> told(const std::vector<Heard>& all, unsigned pes) {
  std::vector<std::vector<Cycles>> times(pes);
  for (const Heard& heard : all) times[heard.source].push_back(heard.as<Cycles>());
  return times;
}

/// 100 bytes, the first word `number`.
void broadcast_number(HostPort& port, std::uint32_t number) {
  std::array<std::uint32_t, 25> words{number};
  port.broadcast(kGo, std::as_bytes(std::span(words)));
}
void send_number(HostPort& port, PeNumber pe, std::uint32_t number) {
  std::array<std::uint32_t, 25> words{number};
  port.send_message(pe, kGo, std::as_bytes(std::span(words)));
}

TEST(Broadcast, IsOneMessageMadeOneTransferAndHeardByAllAtOnce) {
  // As long as a message to one PE (Costs.AMessageOfTheHost): made in 51, seen by the arbiter after 4, on the bus for
  // 4 + ceil(108 / 8) = 18, copied into local memory in 14, at every PE in the same cycle.
  constexpr unsigned kPes = 6;
  MachineSetup setup = small_machine(3, 2);
  ListeningHost host(kPes);
  host.at_start = [](HostPort& port) {
    broadcast_number(port, 0);
    EXPECT_EQ(port.queued(4), 1U);
  };
  const MachineOutcome outcome = run(setup, host, tell_times(1, std::vector<Cycles>(kPes)), short_hints());
  for (const auto& times : told(outcome.heard, kPes)) EXPECT_EQ(times, std::vector<Cycles>{51 + 4 + 18 + 14});
  const BusFigures& bus = outcome.raw.bus;
  const BusTraffic& kind = bus.kinds[static_cast<std::size_t>(BusKind::broadcast)];
  EXPECT_EQ(kind.transfers, 1U);
  EXPECT_EQ(kind.bytes, 108U);
  EXPECT_EQ(kind.cycles, 18U);
  EXPECT_EQ(bus.transfers, 1U + kPes) << "the PEs' answers";
  EXPECT_EQ(bus.users[static_cast<std::size_t>(BusUser::host)].transfers, 1U);
  for (const BusTraffic& to : bus.to_pe) EXPECT_EQ(to.transfers, 0U);
  EXPECT_EQ(outcome.raw.host.items[static_cast<std::size_t>(HostWork::message)], 1U + kPes);
}

TEST(Broadcast, JitterIsTheSameToAll) {
  MachineSetup setup = small_machine(3, 2);
  setup.description.jitter = {7, 50};
  ListeningHost host(4 * 6);
  host.at_start = [](HostPort& port) {
    for (std::uint32_t i = 0; i < 4; ++i) broadcast_number(port, i);
  };
  const auto times = told(run(setup, host, tell_times(4, std::vector<Cycles>(6)), short_hints()).heard, 6);
  for (const auto& pe : times) EXPECT_EQ(pe, times[0]);
  EXPECT_NE(times[0].at(0), 51U + 4 + 18 + 14) << "there is some";
}

TEST(Broadcast, WaitsForAFreeControlBufferAtEveryPe) {
  // One buffer each. PE 1 takes the first broadcast out of its buffer only at 1000 + HINT 1 + 14 of the copy; known at
  // its NIU one cycle later, at the host 4, at the arbiter 4; then the second goes, to both.
  MachineSetup setup = small_machine(2, 1);
  setup.description.bus.control_buffers = 1;
  ListeningHost host(4);
  host.at_start = [](HostPort& port) {
    for (std::uint32_t i = 0; i < 2; ++i) broadcast_number(port, i);
  };
  const auto times = told(run(setup, host, tell_times(2, {0, 1000}), short_hints()).heard, 2);
  EXPECT_EQ(times[0].at(0), 51U + 4 + 18 + 14);
  EXPECT_EQ(times[1].at(0), 1000U + 1 + 14);
  // The arbiter has seen PE 1's answer one cycle before (Costs.AControlBufferThatHasBecomeFreeIsSeenLater): 4 + 2.
  for (const auto& pe : times) EXPECT_EQ(pe.at(1), 1000U + 1 + 14 + 8 + 6 + 18 + 14);
}

TEST(Broadcast, WaitsForEarlierSendsAndLaterOnesWaitForIt) {
  // One buffer each. PE 1 is asleep on its first message until 1000, so its second waits; the broadcast waits for that,
  // and the message to PE 0 behind it, though PE 0 has had a free buffer all the time.
  MachineSetup setup = small_machine(2, 1);
  setup.description.bus.control_buffers = 1;
  ListeningHost host(5);
  host.at_start = [](HostPort& port) {
    send_number(port, 1, 0);
    send_number(port, 1, 1);
    broadcast_number(port, 2);
    send_number(port, 0, 3);
    EXPECT_EQ(port.queued(0), 2U);
    EXPECT_EQ(port.queued(1), 3U);
  };
  const MachineOutcome outcome = run(
      setup, host,
      [](Niu& niu, NativeClock& clock) {
        const bool first = niu.pe() == 0;
        clock.spend(first ? 0 : 1000);
        for (std::uint32_t i = 0; i < (first ? 2U : 3U); ++i) {
          niu.receive();
          EXPECT_EQ(niu.message_as<std::uint32_t>(), first ? 2 + i : i);
          niu.send(static_cast<MessageKind>(kText), clock.cycles());
        }
        sleep_for_ever(niu);
      },
      short_hints());
  const auto times = told(outcome.heard, 2);
  EXPECT_GT(times[1].at(1), 1000U);
  EXPECT_GT(times[1].at(2), times[1].at(1));
  EXPECT_EQ(times[0].at(0), times[1].at(2));
  EXPECT_GT(times[0].at(1), times[0].at(0));
}

/// Sends by chance: messages, packets of records and broadcasts, numbered in their order.
class Sends {
 public:
  explicit Sends(unsigned pes) : messages(pes), packets(pes) {
    std::minstd_rand random(5);
    for (std::uint32_t i = 0; i < 250; ++i) {
      const auto kind = static_cast<Kind>(random() % 5 / 2);
      sends_.push_back({kind, static_cast<PeNumber>(random() % pes), 1 + random() % 200});
      for (unsigned pe = 0; pe < pes; ++pe) {
        if (kind == Kind::broadcast || (kind == Kind::message && pe == sends_.back().pe)) messages[pe].push_back(i);
        if (kind == Kind::packet && pe == sends_.back().pe) packets[pe].push_back(i);
      }
    }
  }
  void make(HostPort& port) const {
    for (std::uint32_t i = 0; i < sends_.size(); ++i) {
      const auto& [kind, pe, length] = sends_[i];
      const std::vector<std::uint32_t> words(length, i);
      const std::array<TestRecord, 2> records = {TestRecord{pe, i, 0, 0, {}}, TestRecord{pe, i, 0, 0, {}}};
      if (kind == Kind::message) port.send_message(pe, kGo, std::as_bytes(std::span(words)));
      if (kind == Kind::packet) port.send_records(pe, std::as_bytes(std::span(records)), sizeof(TestRecord));
      if (kind == Kind::broadcast) port.broadcast(kGo, std::as_bytes(std::span(words)));
    }
  }

  std::vector<std::vector<std::uint32_t>> messages, packets;  ///< by PE, what it must see: numbers in order

 private:
  enum class Kind : std::uint8_t { message, packet, broadcast };
  struct Send {
    Kind kind;
    PeNumber pe;
    std::size_t length;
  };
  std::vector<Send> sends_;
};

/// Receives all of these sends to a PE, slower or faster by PE. Records are copied into memory later than messages, so
/// only each kind's order is sure.
void expect_in_order(Niu& niu, NativeClock& clock, const Sends& sends) {
  set_test_slots(niu, 4);
  const auto& messages = sends.messages[niu.pe()];
  const auto& packets = sends.packets[niu.pe()];
  std::size_t message = 0;
  std::size_t packet = 0;
  while (message < messages.size() || packet < packets.size()) {
    const auto& arrival = niu.receive();
    clock.spend(100 + 700 * (niu.pe() % 3));
    if (arrival.kind == ArrivalKind::message) {
      EXPECT_EQ(niu.message_as<std::uint32_t>(), messages.at(message++));
      continue;
    }
    const auto slots = arrival.slots;
    const std::uint32_t records = arrival.count;
    EXPECT_EQ(record(niu, slots[0]).number, packets.at(packet++));
    for (std::uint32_t i = 0; i < records; ++i) niu.release(slots[i]);
  }
  niu.send(static_cast<MessageKind>(kDone));
  sleep_for_ever(niu);
}

// Whatever has room first: each PE sees its own messages and all broadcasts in the host's order, and its own packets.
TEST(Broadcast, KeepsTheOrderOfSendsAtEachPe) {
  const Sends sends(6);
  for (const bool ideal : {false, true}) {
    MachineSetup setup = small_machine(3, 2);
    setup.description.bus.control_buffers = 2;
    setup.description.ideal.signals = setup.description.ideal.host = ideal;
    ListeningHost host(6);
    host.at_start = [&](HostPort& port) { sends.make(port); };
    run(setup, host, [&](Niu& niu, NativeClock& clock) { expect_in_order(niu, clock, sends); });
    EXPECT_EQ(host.heard.size(), 6U);
  }
}

TEST(Broadcast, AmidWanderersOfTheSmallestMachineIsTheSameWhateverTheThreadsDo) {
  // Most records are diverted and come back by the host, which answers every tenth message by a broadcast to all.
  MachineSetup setup = small_machine(4, 3);
  take_least_queues(setup.description);
  std::uint32_t told = 0;
  const auto answer = [&told](HostPort& port, const Heard& heard) {
    if (++told % 10 == 0) port.broadcast(kGo, heard.bytes);
    if (told % 10 == 5) port.send_message(heard.source, kGo, heard.bytes);
  };
  expect_same_runs(setup, wanderers(40, 12, 2), 12 * 40, 3, [&](CountingHost& host) {
    told = 0;
    host.at_message = answer;
  });
  EXPECT_GT(told, 20U) << "some broadcasts";
}

// A processor that is behind by the computer's time, not by its clock: what the ring between the two sides cannot hold
// waits on the network's side.
TEST(Broadcast, IsWholeWhereTheRingToTheProcessorIsFull) {
  static constexpr std::uint32_t kPackets = kMostRingBytes / protocol::kMostPacketBytes + 10;
  ListeningHost host(1);
  host.at_start = [](HostPort& port) {
    const std::array<TestRecord, 16> records{};
    for (std::uint32_t i = 0; i < kPackets; ++i) {
      port.send_records(0, std::as_bytes(std::span(records)), sizeof(TestRecord));
    }
    broadcast_number(port, 77);
  };
  const MachineOutcome outcome = run(small_machine(1, 1), host, [](Niu& niu, NativeClock& clock) {
    set_test_slots(niu, 16 * kPackets);
    clock.spend(1'000'000);
    niu.clock();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // the network goes on up to that cycle
    for (std::uint32_t packets = 0; packets <= kPackets; ++packets) {
      const auto& arrival = niu.receive();
      if (arrival.kind != ArrivalKind::message) continue;
      EXPECT_GE(packets, kPackets - 1) << "records are copied longer, so the last may come behind it";
      EXPECT_EQ(arrival.source, protocol::kHost);
      EXPECT_EQ(niu.message().kind, kGo);
      EXPECT_EQ(niu.message_bytes().size(), 100U);
      niu.send(static_cast<MessageKind>(kDone), niu.message_as<std::uint32_t>());
    }
    sleep_for_ever(niu);
  });
  EXPECT_EQ(outcome.heard.at(0).as<std::uint32_t>(), 77U);
}

TEST(Broadcast, ThatNobodyTakesIsADeadlock) {
  ListeningHost host(0);
  host.at_start = [](HostPort& port) {
    for (std::uint32_t i = 0; i < 5; ++i) broadcast_number(port, i);
    send_number(port, 0, 5);
  };
  const std::string report = failure_of(small_machine(2, 1), host, [](Niu& niu, NativeClock& /*clock*/) {
    if (niu.pe() == 0) sleep_for_ever(niu);
  });
  // PE 1 has halted, and two broadcasts lie in its control buffers.
  EXPECT_THAT(report, HasSubstr("deadlock"));
  EXPECT_THAT(report, HasSubstr("4 broadcasts and what waits for them"));
}

TEST(Broadcast, LongerThanAMessageEndsTheRun) {
  ListeningHost host(0);
  host.at_start = [](HostPort& port) { port.broadcast(kGo, std::vector<std::byte>(protocol::kMostMessageBytes + 1)); };
  EXPECT_THAT(failure_of(small_machine(1, 1), host, [](Niu& niu, NativeClock& /*clock*/) { sleep_for_ever(niu); }),
              HasSubstr("sends all PEs a message of 1025 bytes; the most is 1024"));
}

}  // namespace
}  // namespace torolux::test
