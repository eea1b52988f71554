// SPDX-License-Identifier: MIT
// Proves: what a packet from PE to PE holds goes from rank to rank and not through rank 0, unless somebody looks at it
// there; all is as in one process whenever it comes; nothing is left at the end; what is lost or damaged on the way
// ends the run, and the rank that it came from is named.
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <chrono>

#include "emulator/ranks/content.hpp"
#include "emulator/remote/wire.hpp"
#include "emulator/torus/kind_rules.hpp"
#include "emulator/trace/record_watcher.hpp"
#include "tests/unit/emulator/remote/remote_support.hpp"

namespace torolux::test {
namespace {

using remote::Kind;
using remote::Placing;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""us;
using testing::HasSubstr;

constexpr std::uint32_t kMark = 0xC0FF'EE42U;  // nothing else in a message looks like it
constexpr std::uint32_t kEach = 20;
constexpr unsigned kPes = 6;

/// Each PE sends marked records to the next, of three kinds by turns, and tells the host when all of its own have come.
NativeProgram ring() {
  return [](Niu& niu, NativeClock& clock) {
    set_test_slots(niu, 64);
    for (std::uint32_t i = 0; i < kEach; ++i) {
      TestRecord& out = record(niu, i % kOwnSlots);
      out = {niu.pe(), i, i % 3, 0, {}};
      out.rest.fill(kMark);
      send_one(niu, (niu.pe() + 1) % niu.pes(), static_cast<std::uint16_t>(i % kOwnSlots));
    }
    std::uint32_t right = 0;
    for (std::uint32_t i = 0; i < kEach; ++i) {
      const std::uint16_t slot = niu.receive().slots[0];
      const TestRecord& got = record(niu, slot);
      const bool whole = std::ranges::all_of(got.rest, [](std::uint32_t word) { return word == kMark; });
      if (whole && got.source == (niu.pe() + niu.pes() - 1) % niu.pes() && got.number == i) ++right;
      clock.spend(77);
      niu.release(slot);
    }
    niu.send(static_cast<protocol::MessageKind>(kDone), right);
    sleep_for_ever(niu);
  };
}

std::size_t marks_in(std::span<const std::byte> bytes) {
  std::size_t marks = 0;
  for (std::size_t at = 0; at + sizeof kMark <= bytes.size(); ++at)
    marks += std::memcmp(&bytes[at], &kMark, sizeof kMark) == 0 ? 1 : 0;
  return marks;
}
constexpr std::size_t kAllMarks = std::size_t{kPes} * kEach * 12;

/// Marks that ranks have been sent, and payloads that were left with the others in the end.
struct Seen {
  std::atomic<std::size_t> at_rank_0 = 0, from_rank_0 = 0, between = 0, left = 0, figures = 0;
};

struct RingOutcome {
  std::string figures;
  std::vector<KindFigures> kinds;
};

/// All PEs have got what was sent.
RingOutcome outcome_of(Machine& machine, ListeningHost& host) {
  machine.run(host);
  for (const Heard& heard : host.heard) EXPECT_EQ(heard.as<std::uint32_t>(), kEach);
  return {exact(machine.figures()), machine.figures().record_kinds};
}

/// On ranks, each with another PE than its neighbours have. setup: may say more.
RingOutcome ring_on_ranks(Seen& seen, ListeningHost& host, MachineSetup setup = small_machine(3, 2)) {
  register_native_engine(ring());
  RingOutcome outcome;
  const auto ends = with_ranks(
      {.count = 4, .placing = Placing::cyclic},
      [&](remote::PeRanks& others) {
        setup.ranks = &others;
        Machine machine(setup, empty_image());
        outcome = outcome_of(machine, host);
      },
      [&](ranks::Transport& transport) {
        TappedTransport tapped(transport, [&seen](const ranks::Message& message) {
          (message.from == 0 ? seen.from_rank_0 : seen.between) += marks_in(message.bytes);
          return true;
        });
        remote::serve_pes(tapped, "the same");
      },
      [&](const ranks::Message& message) {
        seen.at_rank_0 += marks_in(message.bytes);
        if (message.kind != static_cast<std::uint32_t>(Kind::figures)) return true;
        std::array<std::uint64_t, 2> begin{};  // of which the second is how many payloads are left
        std::memcpy(begin.data(), message.bytes.data(), sizeof begin);
        seen.left += begin[1];
        ++seen.figures;
        return true;
      });
  for (const std::string& end : ends) EXPECT_EQ(end, "");
  return outcome;
}

RingOutcome ring_alone(ListeningHost& host) {
  register_native_engine(ring());
  Machine machine(small_machine(3, 2), empty_image());
  return outcome_of(machine, host);
}

TEST(Payloads, GoFromRankToRank) {
  ListeningHost host(kPes);
  Seen seen;
  const RingOutcome outcome = ring_on_ranks(seen, host);
  EXPECT_EQ(seen.at_rank_0, 0U);
  EXPECT_EQ(seen.from_rank_0, 0U);
  EXPECT_EQ(seen.between, kAllMarks);
  EXPECT_GE(seen.figures, 3U);
  EXPECT_EQ(seen.left, 0U);
  ListeningHost again(kPes);
  EXPECT_EQ(outcome.figures, ring_alone(again).figures);
}

/// Two kinds of records, and one that it may know only by a record as a whole.
class KindsHost : public ListeningHost {
 public:
  KindsHost() : ListeningHost(kPes) {}
  std::span<const std::string_view> record_kinds() const override {
    static constexpr std::array<std::string_view, 3> kNames = {"first", "second", "third"};
    return kNames;
  }
  std::size_t record_kind(std::span<const std::byte> record) const override {
    return std::to_integer<std::size_t>(record[offsetof(TestRecord, life)]);
  }
};

class RuledHost final : public KindsHost, public HasKindRules {
 public:
  std::span<const KindRule> kind_rules() const override {
    static constexpr std::array<KindRule, 3> kRules = {{{sizeof(TestRecord), offsetof(TestRecord, life), 3, 1, 1},
                                                        {sizeof(TestRecord), offsetof(TestRecord, life), 2, 2, 2},
                                                        {sizeof(TestRecord), 0, 0, 0, 0}}};
    return kRules;
  }
};

void expect_kinds_as_alone(const RingOutcome& outcome) {
  KindsHost host;
  const RingOutcome expected = ring_alone(host);
  EXPECT_EQ(outcome.figures, expected.figures);
  ASSERT_EQ(outcome.kinds.size(), expected.kinds.size());
  for (std::size_t kind = 0; kind < expected.kinds.size(); ++kind) {
    EXPECT_GT(expected.kinds[kind].records, 0U);
    EXPECT_EQ(outcome.kinds[kind].records, expected.kinds[kind].records);
    EXPECT_EQ(outcome.kinds[kind].packets, expected.kinds[kind].packets);
    EXPECT_EQ(outcome.kinds[kind].bytes, expected.kinds[kind].bytes);
  }
}

TEST(Payloads, TellTheirKindsByRules) {
  RuledHost host;
  Seen seen;
  expect_kinds_as_alone(ring_on_ranks(seen, host));
  EXPECT_EQ(seen.at_rank_0, 0U);
  EXPECT_EQ(seen.between, kAllMarks);
}

TEST(Payloads, GoThroughRankZeroWhereItAloneKnowsKinds) {
  KindsHost host;
  Seen seen;
  expect_kinds_as_alone(ring_on_ranks(seen, host));
  EXPECT_EQ(seen.at_rank_0, kAllMarks);
  EXPECT_EQ(seen.from_rank_0, kAllMarks);
  EXPECT_EQ(seen.between, 0U);
}

class Watcher final : public RecordWatcher {
 public:
  void sent(Cycles /*time*/, const RecordPacket& packet) override { marks += marks_in(packet.records); }
  void received(Cycles /*time*/, const RecordPacket& packet) override { marks += marks_in(packet.records); }
  void came(Cycles /*time*/, const BusMessage& /*message*/) override {}
  void end(Cycles /*time*/) override {}
  std::size_t marks = 0;
};

TEST(Payloads, GoThroughRankZeroWhereSomebodyLooksAtThem) {
  Watcher watcher;
  MachineSetup setup = small_machine(3, 2);
  setup.record_watcher = &watcher;
  ListeningHost host(kPes);
  Seen seen;
  ring_on_ranks(seen, host, setup);
  EXPECT_EQ(watcher.marks, 2 * kAllMarks);
  EXPECT_EQ(seen.between, 0U);
}

/// Links with errors, so that packets are sent again; few slots, so that packets are diverted.
TEST(Payloads, AreTheSameHoweverLateTheyCome) {
  MachineSetup setup = small_machine(3, 2);
  setup.description.torus.send_queue_packets = 2;
  setup.description.torus.link_error_rate = 0.1;
  const NativeProgram program = wanderers(25, 6, 32);
  constexpr std::uint64_t kRecords = 6 * 25;
  CountingHost host(kRecords);
  const MachineOutcome expected = run(setup, host, program);
  EXPECT_GT(expected.raw.link_retries, 0U);
  std::uint64_t diverted = 0;
  for (const PeFigures& pe : expected.raw.pes) diverted += pe.records_diverted;
  EXPECT_GT(diverted, 0U);

  register_native_engine(program);
  std::atomic<unsigned> words_before_payloads = 0;
  const auto ends = with_ranks(
      {.count = 4, .placing = Placing::cyclic},
      [&](remote::PeRanks& others) {
        MachineSetup on_ranks = setup;
        on_ranks.ranks = &others;
        CountingHost again(kRecords);
        Machine machine(on_ranks, empty_image());
        machine.run(again);
        EXPECT_EQ(exact(machine.figures()), expected.figures);
      },
      [&](ranks::Transport& transport) {
        LateTransport late(transport, static_cast<std::uint32_t>(Kind::payloads), 3000us);
        TappedTransport tapped(late, [&](const ranks::Message& message) {
          if (message.kind == static_cast<std::uint32_t>(Kind::words) && late.holds()) ++words_before_payloads;
          return true;
        });
        remote::serve_pes(tapped, "the same");
      });
  for (const std::string& end : ends) EXPECT_EQ(end, "");
  EXPECT_GT(words_before_payloads, 0U);
}

/// As long as no test's computer is busy for.
constexpr ranks::LifeTimes kShort{20ms, 2000ms};

/// What rank 0 says where rank 1's messages of payloads from rank 2 go through `tap`.
std::string failure_behind(const Tap& tap) {
  const RanksChoice choice{.count = 3, .placing = Placing::cyclic, .times = kShort};
  ListeningHost host(kPes);
  return failure_on(choice, small_machine(3, 2), host, ring(), [&](ranks::Transport& transport) {
    TappedTransport tapped(transport, [&](ranks::Message& message) {
      const bool is_meant = transport.ranks().own == 1 && message.kind == static_cast<std::uint32_t>(Kind::payloads);
      return !is_meant || tap(message);
    });
    remote::serve_pes(tapped, "the same", choice.times);
  });
}

TEST(Payloads, ThatAreLostAreMissed) {
  const std::string failure = failure_behind([](const ranks::Message&) { return false; });
  EXPECT_THAT(failure, HasSubstr("rank 1 ("));
  EXPECT_THAT(failure, HasSubstr("has not come from rank 2: it counts as lost"));
}

TEST(Payloads, ThatAreDamagedAreRefused) {
  const std::string failure = failure_behind([](ranks::Message& message) {
    message.bytes.pop_back();
    return true;
  });
  EXPECT_THAT(failure, HasSubstr("rank 1 ("));
  EXPECT_THAT(failure, HasSubstr("from rank 2 are damaged"));
}

/// Machines that are cut short leave packets on their way; the next one on the same ranks runs all the same. (That what
/// is late of one machine is nobody's in the next: WhatIsLateOfAMachineThatIsNoMoreIsNobodys.)
TEST(Payloads, OfAMachineThatIsCutShortDoNotTroubleTheNextOne) {
  register_native_engine(ring());
  const auto ends =
      with_ranks({.count = 4, .placing = Placing::cyclic, .delays = {3, 2000us}}, [&](remote::PeRanks& others) {
        for (unsigned i = 0; i < 4; ++i) {
          MachineSetup setup = small_machine(3, 2);
          setup.until = i % 2 == 0 ? 1500 : 0;  // cut short: packets are on their way
          setup.ranks = &others;
          ListeningHost host(kPes);
          Machine machine(setup, empty_image());
          machine.run(host);
        }
      });
  for (const std::string& end : ends) EXPECT_EQ(end, "");
}

}  // namespace
}  // namespace torolux::test
