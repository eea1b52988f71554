// SPDX-License-Identifier: MIT
// How a NIU lets records gather before it wakes its processor: when, for what, and that it is the same every time.
#include <gtest/gtest.h>

#include "emulator/engines/engine/shared_memory.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/niu/network_side.hpp"
#include "emulator/niu/processor_side.hpp"
#include "tests/unit/emulator/machine/wanderers.hpp"

namespace torolux::test {

namespace {

constexpr std::uint32_t kTick = 1000;
constexpr Cycles kLead = kTick / 4;
/// From the end of a send of one record to its arrival at the next PE: see Machine.ZeroLoadLatencyIsExact.
constexpr Cycles kLatency = 1 + 8 + 2 * 4 + 4 + 8;

/// What one `receive` and the `receive_more` after it brought.
struct Batch {
  std::uint64_t woken;
  std::uint32_t arrivals;
  std::uint32_t records;
};

/// PE 0's part: one record each to arrive at PE 1 at these times.
void send_to_arrive(Niu& niu, NativeClock& clock, const std::vector<Cycles>& arrive) {
  for (std::size_t i = 0; i < arrive.size(); ++i) {
    clock.spend(arrive[i] - kLatency - 1 - clock.cycles());
    record(niu, static_cast<std::uint32_t>(i)) = {};
    send_one(niu, 1, static_cast<std::uint16_t>(i));
  }
}

/// The next wake-up.
Batch receive_batch(Niu& niu, const NativeClock& clock) {
  Batch batch{0, 0, 0};
  for (const auto* arrival = &niu.receive(); arrival->kind != ArrivalKind::none; arrival = &niu.receive_more()) {
    if (batch.arrivals == 0) batch.woken = clock.cycles();
    ++batch.arrivals;
    batch.records += arrival->count;
  }
  return batch;
}

/// PE 0 sends one record each to arrive at PE 1 at the times given; the batches in which PE 1 gets them.
std::vector<Batch> batches(const std::vector<Cycles>& arrive, std::uint32_t enough,
                           const std::function<void(HostPort&)>& at_start = {}, std::uint32_t messages = 0) {
  const auto program = [&](Niu& niu, NativeClock& clock) {
    set_test_slots(niu, 64);
    if (niu.pe() == 0) {
      send_to_arrive(niu, clock, arrive);
    } else if (niu.pe() == 1) {
      niu.gather(kTick, enough);
      for (std::size_t got = 0; got < arrive.size() + messages;) {
        const Batch batch = receive_batch(niu, clock);
        got += batch.arrivals;
        niu.send(static_cast<protocol::MessageKind>(kText), batch);
      }
      niu.send(static_cast<protocol::MessageKind>(kDone));
    }
    sleep_for_ever(niu);
  };
  NativeOptions options;
  options.cycles_per_hint = 1;
  class Host final : public ListeningHost {
   public:
    Host() : ListeningHost(0) {}
    bool finished() const override { return !heard.empty() && heard.back().kind == kDone; }
  } host;
  host.at_start = at_start;
  run(small_machine(2, 1), host, program, options);
  std::vector<Batch> result;
  for (const Heard& one : host.heard) {
    if (one.kind == kText) result.push_back(one.as<Batch>());
  }
  return result;
}

TEST(Gather, WakesAtATickForWhatHadComeAQuarterBefore) {
  // The first two have come at 2000 - 250, the third 30 cycles later: it is for the tick after.
  const auto got = batches({1300, 2000 - kLead, 2000 - kLead + 30}, 64);
  ASSERT_EQ(got.size(), 2U);
  EXPECT_EQ(got[0].woken, 2000U);
  EXPECT_EQ(got[0].arrivals, 2U);
  EXPECT_EQ(got[1].woken, 3000U);
  EXPECT_EQ(got[1].arrivals, 1U);
}

TEST(Gather, EnoughRecordsWakeAtOnce) {
  const auto got = batches({1300, 1340, 1380, 1420}, 3);
  ASSERT_EQ(got.size(), 2U);
  EXPECT_EQ(got[0].woken, 1380U);
  EXPECT_EQ(got[0].records, 3U);
  EXPECT_EQ(got[1].woken, 2000U);
}

TEST(Gather, AMessageWakesAtOnceAndEndsWhatIsGathered) {
  // Host message: made in 50 cycles per message before it, so some hundreds of them arrive between records.
  const auto go = [](HostPort& port) { port.send_message(1, kGo, {}); };
  const auto got = batches({1300, 1340}, 64, go, 1);
  ASSERT_EQ(got.size(), 2U);
  EXPECT_LT(got[0].woken, 200U);
  EXPECT_EQ(got[0].records, 0U);
  EXPECT_EQ(got[1].woken, 2000U);
  EXPECT_EQ(got[1].records, 2U);
}

TEST(Gather, ABusyProcessorTakesWhatATickWouldHaveBroughtIt) {
  // PE 1 works from 2000 until long after 4000: the records of the ticks at 3000 and 4000 come in two batches, at once.
  const std::vector<Cycles> arrive = {1300, 2100, 2200, 3100};
  ListeningHost host(1);
  NativeOptions options;
  options.cycles_per_hint = 1;
  std::vector<Batch> got;
  run(
      small_machine(2, 1), host,
      [&](Niu& niu, NativeClock& clock) {
        set_test_slots(niu, 64);
        if (niu.pe() == 0) {
          send_to_arrive(niu, clock, arrive);
        } else {
          niu.gather(kTick, 64);
          for (int i = 0; i < 3; ++i) {
            got.push_back(receive_batch(niu, clock));
            if (i == 0) clock.spend(9000 - clock.cycles());
          }
          niu.send(static_cast<protocol::MessageKind>(kDone));
        }
        sleep_for_ever(niu);
      },
      options);
  ASSERT_EQ(got.size(), 3U);
  EXPECT_EQ(got[0].woken, 2000U);
  EXPECT_EQ(got[1].arrivals, 2U);
  EXPECT_EQ(got[1].woken, 9001U);
  EXPECT_EQ(got[2].arrivals, 1U);
  EXPECT_LT(got[2].woken, 9020U);
}

/// What `receive_due` brings, one look after another until there is none.
std::uint32_t look(Niu& niu) {
  std::uint32_t arrivals = 0;
  while (niu.receive_due().kind != ArrivalKind::none) ++arrivals;
  return arrivals;
}

/// A processor that never sleeps, and looks at these times: how many arrivals it gets at each.
std::vector<std::uint32_t> looks(const std::vector<Cycles>& arrive, const std::vector<Cycles>& at, std::uint32_t cycles,
                                 const std::function<void(HostPort&)>& at_start = {}) {
  ListeningHost host(1);
  host.at_start = at_start;
  NativeOptions options;
  options.cycles_per_hint = 1;
  std::vector<std::uint32_t> got;
  run(
      small_machine(2, 1), host,
      [&](Niu& niu, NativeClock& clock) {
        set_test_slots(niu, 64);
        if (niu.pe() == 0) {
          send_to_arrive(niu, clock, arrive);
        } else {
          niu.gather(cycles, 64);
          for (const Cycles time : at) {
            clock.spend(time - 1 - clock.cycles());  // the look itself takes one
            got.push_back(look(niu));
          }
          niu.send(static_cast<protocol::MessageKind>(kDone));
        }
        sleep_for_ever(niu);
      },
      options);
  return got;
}

TEST(Due, ABusyProcessorSeesWhatHadComeAQuarterBeforeItsLastTick) {
  // Two have come at 2000 - 250, the third 30 cycles later: whoever looks before 2000 sees none, up to 2999 two of
  // them.
  const std::vector<Cycles> arrive = {1300, 2000 - kLead, 2000 - kLead + 30};
  EXPECT_EQ(looks(arrive, {1500, 1990, 2000, 2020, 2980, 3000}, kTick), (std::vector<std::uint32_t>{0, 0, 2, 0, 0, 1}));
  EXPECT_EQ(looks(arrive, {100, 9000}, kTick), (std::vector<std::uint32_t>{0, 3})) << "late, and all at once";
}

TEST(Due, WithoutTicksItIsWhatHasCome) {
  EXPECT_EQ(looks({1300, 1400}, {1299, 1300, 1399, 1450}, 0), (std::vector<std::uint32_t>{0, 1, 0, 1}));
}

TEST(Due, MessagesWaitForItLikeRecords) {
  const auto go = [](HostPort& port) { port.send_message(1, kGo, {}); };  // it comes before 200
  EXPECT_EQ(looks({1300}, {900, 1000, 1020, 2000}, kTick, go), (std::vector<std::uint32_t>{0, 1, 0, 1}));
}

TEST(Gather, MoreThanTheRingHoldsIsStillOneBatch) {
  // More than kManyPes PEs, so the rings are small: 1500 packets overflow PE 0's by far.
  constexpr std::uint32_t kEach = 21;
  const auto pes = kManyPes + 8;
  Batch got{0, 0, 0};
  ListeningHost host(1);
  run(small_machine(8, 9), host, [&](Niu& niu, NativeClock& clock) {
    set_test_slots(niu, niu.pe() == 0 ? 2048 : 0);
    if (niu.pe() == 0) {
      niu.gather(1'000'000, 4096);
      got = receive_batch(niu, clock);
      niu.send(static_cast<protocol::MessageKind>(kDone));
    } else {
      for (std::uint32_t i = 0; i < kEach; ++i) {
        record(niu, i) = {};
        send_one(niu, 0, static_cast<std::uint16_t>(i));
      }
    }
    sleep_for_ever(niu);
  });
  EXPECT_EQ(got.arrivals, (pes - 1) * kEach);
}

TEST(Gather, AProcessorThatGoesOnByItselfIsNotThoughtToSleep) {
  // The network side may see that an arrival has been taken before it sees that the processor waits no longer.
  SharedMemory memory("test-channel", niu_channel_bytes());
  NiuChannel& channel = *niu_channel_at(memory.bytes().data());
  NiuNetworkSide network(channel, 0, 1, MachineDescription(), nullptr);
  EventQueue events(4);
  BlockPool pool;
  PeTimes times{BoundTree(1, kCommandCycles), BoundTree(1, kNever)};
  std::vector<std::byte> local(64U * 1024U);
  auto& window = *reinterpret_cast<protocol::NiuWindow*>(local.data());
  NiuProcessorSide processor(channel, local, 0, NiuProcessorSide::Waiting::returns);
  constexpr auto kReceive = static_cast<std::int32_t>(protocol::Hint::receive);
  ASSERT_EQ(processor.hint(kReceive, 10, 0).outcome, NiuProcessorSide::Outcome::retry);
  network.refresh(events, pool, times);
  const BlockIndex block = pool.take();
  pool[block].message_kind = kGo;
  network.deliver(block, 50, pool, times);
  const std::uint64_t waited = channel.wait.load();
  ASSERT_EQ(processor.hint(kReceive, 10, 0).clock, 50U + 1);  // its header of 8 bytes is copied
  channel.wait.store(waited);                                 // not seen yet
  network.refresh(events, pool, times);
  EXPECT_EQ(times.bounds.least(), channel.bound.load());
  EXPECT_EQ(window.retry, 0U);
}

/// As gatherers, but with work of their own: each record that a PE makes takes it some time, after which it looks for
/// what is due. It sleeps when there is no more to make.
NativeProgram workers(std::uint32_t per_pe, std::uint32_t life, std::uint32_t cycles, std::uint32_t enough) {
  return [=](Niu& niu, NativeClock& clock) {
    set_test_slots(niu, 256);
    niu.gather(cycles, enough);
    for (std::uint32_t made = 0;;) {
      const bool busy = made < per_pe;
      if (busy) {
        clock.spend(40 + 13 * (made % 7));
        set_out(niu, made++, life);
      }
      std::uint32_t died = 0;
      const auto* arrival = busy ? &niu.receive_due() : &niu.receive();
      for (; arrival->kind != ArrivalKind::none; arrival = busy ? &niu.receive_due() : &niu.receive_more()) {
        const auto slots = arrival->slots;
        const std::uint32_t count = arrival->count;
        for (std::uint32_t i = 0; i < count; ++i) died += wander_on(niu, clock, slots[i]) ? 1 : 0;
      }
      if (died != 0) niu.send(static_cast<protocol::MessageKind>(kDone), died);
    }
  };
}

class GatherRepeats : public testing::TestWithParam<std::uint32_t> {};

TEST_P(GatherRepeats, SameRunWhateverTheThreadsDo) {
  MachineSetup setup = small_machine(3, 3);
  setup.description.torus.send_queue_packets = 2;
  expect_same_runs(setup, gatherers(60, 12, GetParam(), 20), 9 * 60, 5);
}

TEST_P(GatherRepeats, SameRunOfBusyProcessorsToo) {
  MachineSetup setup = small_machine(3, 3);
  setup.description.torus.send_queue_packets = 2;
  expect_same_runs(setup, workers(60, 12, GetParam(), 20), 9 * 60, 5);
}

INSTANTIATE_TEST_SUITE_P(Ticks, GatherRepeats, testing::Values(0U, 100U, 5'000U));

}  // namespace

}  // namespace torolux::test
