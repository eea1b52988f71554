// SPDX-License-Identifier: MIT
// Proves: arrivals go into a PE's ring in the order of the network's words, whenever their payloads come; what waits
// holds wake-ups and the horizon back; payloads and the places that stand for them are gone once they have arrived.
#include <gmock/gmock.h>

#include <memory>

#include "emulator/errors.hpp"
#include "emulator/niu/network_side.hpp"
#include "emulator/niu/pop_arrival.hpp"
#include "emulator/remote/arrival_line.hpp"
#include "emulator/remote/network_end.hpp"
#include "emulator/remote/payload_lanes.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux::remote {
namespace {

constexpr std::uint16_t kSource = 7, kOther = 8, kDestination = 3;
constexpr std::uint32_t kBytes = 64;

std::vector<std::byte> payload_of(std::uint8_t value) {
  return std::vector<std::byte>(kBytes, std::byte{value});
}

PacketName name_of(std::uint64_t number, std::uint16_t source = kSource) {
  return {number, source, kDestination, kBytes};
}

std::unique_ptr<NiuChannel> new_channel() {
  auto channel = std::make_unique<NiuChannel>();
  set_up_channel(*channel, 16, MachineDescription(), true);
  return channel;
}

class ArrivalLineTest : public testing::Test {
 protected:
  /// A word of a packet whose payload comes another way.
  void tell(std::uint64_t time, const PacketName& name) {
    Arrival arrival{};
    arrival.time = time;
    arrival.kind = static_cast<std::uint16_t>(protocol::ArrivalKind::records);
    arrival.source = name.source;
    arrival.count = 1;
    arrival.lent = static_cast<std::uint16_t>(name.bytes);
    told_.put(arrival);
    told_.put(name);
    ++words_.arrivals;
  }
  /// One of a message of the host.
  void tell_message(std::uint64_t time, const std::vector<std::byte>& contents) {
    Arrival arrival{};
    arrival.time = time;
    arrival.bytes = static_cast<std::uint32_t>(contents.size());
    told_.put(arrival);
    told_.put_bytes(contents);
    ++words_.arrivals;
  }
  void take(std::uint64_t horizon, std::uint64_t wakes = 0) {
    words_.horizon = horizon;
    words_.wakes = wakes;
    words_.wake_time = 10 * wakes;
    ByteReader reader(told_.bytes());
    line_.take(words_, reader);
    EXPECT_TRUE(reader.empty());
    told_.clear();
    words_ = {};
  }
  /// The first byte of each arrival that the processor finds, which takes them.
  std::vector<int> found() {
    std::vector<int> values;
    while (const Arrival* arrival = channel_->arrivals.front()) {
      values.push_back(std::to_integer<int>(contents_of(*arrival)[0]));
      pop_arrival(*channel_, *arrival);
    }
    return values;
  }

  std::unique_ptr<NiuChannel> channel_ = new_channel();
  ArrivalLine line_{*channel_, kDestination};
  ByteWriter told_;
  Words words_{};
};

TEST_F(ArrivalLineTest, APayloadThatIsThereFirstGoesAtOnce) {
  line_.keep(name_of(0), payload_of(1));
  EXPECT_EQ(line_.unnamed(), 1U);
  tell(100, name_of(0));
  take(150, 1);
  EXPECT_FALSE(line_.waits());
  EXPECT_EQ(channel_->horizon.load(), 150U);
  EXPECT_EQ(channel_->wakes.load(), 1U);
  EXPECT_EQ(found(), (std::vector{1}));
  EXPECT_EQ(line_.unnamed(), 0U);
}

TEST_F(ArrivalLineTest, OneThatComesBehindItsWordHoldsBackAllBehindIt) {
  tell(100, name_of(0));
  tell_message(110, payload_of(2));
  take(150, 1);
  EXPECT_EQ(found(), std::vector<int>{});
  EXPECT_EQ(channel_->horizon.load(), 100U);  // up to there nothing else has come
  EXPECT_EQ(channel_->wakes.load(), 0U);      // a processor that wakes up looks into its ring
  EXPECT_EQ(line_.awaited(), name_of(0));
  EXPECT_FALSE(line_.refill());

  line_.keep(name_of(0), payload_of(1));
  EXPECT_EQ(line_.awaited(), std::nullopt);
  EXPECT_TRUE(line_.refill());
  EXPECT_EQ(channel_->horizon.load(), 150U);
  EXPECT_EQ(channel_->wakes.load(), 1U);
  EXPECT_EQ(channel_->wake_time.load(), 10U);
  EXPECT_EQ(found(), (std::vector{1, 2}));
  EXPECT_FALSE(line_.waits());
}

TEST_F(ArrivalLineTest, TheOrderIsThatOfTheWords) {
  tell(100, name_of(0));
  tell(101, name_of(0, kOther));
  tell(102, name_of(1));
  take(150);
  line_.keep(name_of(1), payload_of(3));
  line_.keep(name_of(0, kOther), payload_of(2));
  EXPECT_FALSE(line_.refill());
  EXPECT_EQ(line_.unnamed(), 0U);
  line_.keep(name_of(0), payload_of(1));
  EXPECT_TRUE(line_.refill());
  EXPECT_EQ(found(), (std::vector{1, 2, 3}));
}

TEST_F(ArrivalLineTest, WaitsForRoomAsForPayloads) {
  constexpr unsigned kMany = 1000;
  for (unsigned i = 0; i < kMany; ++i) {
    line_.keep(name_of(i), payload_of(static_cast<std::uint8_t>(i)));
    tell(100 + i, name_of(i));
  }
  take(5000);
  EXPECT_TRUE(line_.waits());
  std::vector<int> all;
  do {
    const std::vector<int> some = found();
    all.insert(all.end(), some.begin(), some.end());
  } while (line_.refill());
  ASSERT_EQ(all.size(), kMany);
  for (unsigned i = 0; i < kMany; ++i) EXPECT_EQ(all[i], static_cast<std::uint8_t>(i));
  EXPECT_EQ(channel_->horizon.load(), 5000U);
  EXPECT_EQ(line_.unnamed(), 0U);
}

TEST_F(ArrivalLineTest, GivesEachPayloadBackOnce) {
  line_.keep(name_of(5), payload_of(9));
  EXPECT_THROW(line_.keep(name_of(5), payload_of(9)), MachineFailure);
  EXPECT_EQ(line_.give(name_of(5)), payload_of(9));
  EXPECT_THROW(line_.give(name_of(5)), MachineFailure);
  EXPECT_EQ(line_.unnamed(), 0U);
}

TEST_F(ArrivalLineTest, AWordOfAnotherPacketIsRefused) {
  PacketName name = name_of(0);
  name.destination = kDestination + 1;
  tell(100, name);
  EXPECT_THROW(take(150), MachineFailure);
}

TEST(StandIns, LeaveNothingBehind) {
  BlockPool pool;
  const auto mirror = new_channel();
  mirror->payloads = &pool.payloads();
  StandIns stand_ins;
  NetworkEnd end(*mirror, stand_ins);
  Command command{};
  command.kind = CommandKind::send_records;
  command.destination = kDestination;
  command.records = 1;
  command.lent = kBytes;
  ByteWriter commands;
  commands.put(command);
  ByteReader reader(commands.bytes());
  News news{};
  news.pe = kSource;
  news.commands = 1;
  end.take(news, reader);

  const Command* taken = mirror->commands.front();
  ASSERT_NE(taken, nullptr);
  ASSERT_NE(taken->payload, nullptr);
  EXPECT_EQ(taken->lent, kBytes);
  EXPECT_EQ(stand_ins.all_for([](unsigned) { return true; }).size(), 1U);
  Arrival arrival{};
  arrival.source = kSource;
  arrival.payload = taken->payload;
  arrival.lent = taken->lent;
  mirror->commands.pop(*taken);
  mirror->arrivals.push(arrival, {});

  ByteWriter words;
  EXPECT_TRUE(end.collect(kDestination, words));
  ByteReader told(words.bytes());
  EXPECT_EQ(told.get<Words>().arrivals, 1U);
  EXPECT_EQ(told.get<Arrival>().lent, kBytes);
  EXPECT_EQ(told.get<PacketName>(), name_of(0));
  EXPECT_TRUE(told.empty());
  EXPECT_TRUE(stand_ins.all_for([](unsigned) { return true; }).empty());
  EXPECT_EQ(pool.payloads().in_use(), 0U);
}

/// PE kSource is on rank 2, PE kDestination on rank 1, all others on rank 3.
std::vector<unsigned> ranks_of() {
  std::vector<unsigned> ranks(16, 3);
  ranks[kSource] = 2;
  ranks[kDestination] = 1;
  return ranks;
}

class PayloadLanesTest : public testing::Test {
 protected:
  std::vector<std::byte> send(std::uint8_t value) {
    outbox_.put(name_of(sent_++), payload_of(value));
    std::vector<std::byte> message;
    outbox_.send_all([&](unsigned rank, std::span<const std::byte> bytes) {
      EXPECT_EQ(rank, 1U);
      message.assign(bytes.begin(), bytes.end());
    });
    EXPECT_EQ(outbox_.bytes(), 0U);
    return message;
  }
  std::string read(const std::vector<std::byte>& message) {
    try {
      inbox_.read(2, message, [this](const PacketName& name, std::span<const std::byte> payload) {
        EXPECT_EQ(payload.size(), name.bytes);
        read_.push_back(std::to_integer<int>(payload[0]));
      });
      return "";
    } catch (const MachineFailure& failure) {
      return failure.what();
    }
  }

  PayloadOutbox outbox_{5, ranks_of()};
  PayloadInbox inbox_{5, ranks_of(), 1};
  std::uint64_t sent_ = 0;
  std::vector<int> read_;
};

TEST_F(PayloadLanesTest, GatherWhatIsForARank) {
  outbox_.put(name_of(sent_++), payload_of(1));
  EXPECT_EQ(read(send(2)), "");
  EXPECT_EQ(read_, (std::vector{1, 2}));
}

TEST_F(PayloadLanesTest, ALostMessageIsNoticed) {
  EXPECT_EQ(read(send(1)), "");
  send(2);
  const std::string failure = read(send(3));
  EXPECT_THAT(failure, testing::HasSubstr("rank 2"));
  EXPECT_THAT(failure, testing::HasSubstr("lost"));
  EXPECT_EQ(read_, (std::vector{1}));
}

TEST_F(PayloadLanesTest, ADamagedMessageIsNoticed) {
  std::vector<std::byte> message = send(1);
  message.pop_back();
  EXPECT_THAT(read(message), testing::HasSubstr("rank 2 are damaged"));
  message = send(1);
  std::vector<std::byte> misled = message;
  misled[sizeof(PayloadsBegin) + offsetof(PacketName, destination)] = std::byte{kOther};
  EXPECT_THAT(read(misled), testing::HasSubstr("rank 2 are damaged"));
  EXPECT_TRUE(read_.empty());
}

TEST_F(PayloadLanesTest, WhatIsLateOfAMachineThatIsNoMoreIsNobodys) {
  PayloadInbox next(6, ranks_of(), 1);
  next.read(2, send(1), [](const PacketName&, std::span<const std::byte>) { FAIL(); });
}

}  // namespace
}  // namespace torolux::remote
