// SPDX-License-Identifier: MIT
// Who goes first: the oldest of a cycle's requests, whatever the order of events; and nobody waits for ever.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/emulator/torus/torus_driver.hpp"

namespace torolux::test {

namespace {

TEST(TorusArbitration, SeesAllRequestsOfACycleAndTakesTheOldest) {
  // A, from PE 0, is at router 1 at cycle 4. In the same cycle PE 1 offers B for the same link, by an event that comes
  // before A's. A has been on its way for longer.
  TorusDriver driver(8, 1, {});
  std::map<unsigned, Cycles> at;
  driver.on_delivery = [&](const auto& delivery) { at[delivery.source] = delivery.delivered; };
  driver.send(0, 2, 8, 0);
  driver.send(1, 2, 8, 4);
  driver.run();
  EXPECT_EQ(at[0], 3 * 4 + 7U);
  EXPECT_EQ(at[1], 4 + 8 + 2 * 4 + 7U);
}

TEST(TorusArbitration, EqualOnesTakeTurns) {
  TorusDriver driver(8, 1, {});
  std::vector<unsigned> order;
  driver.on_delivery = [&](const auto& delivery) { order.push_back(delivery.source); };
  for (unsigned i = 0; i < 4; ++i) {
    for (const unsigned from : {0U, 2U}) driver.send(from, 1, 8, 0);
  }
  driver.run();
  ASSERT_EQ(order.size(), 8U);
  for (std::size_t i = 1; i < order.size(); ++i) EXPECT_NE(order[i], order[i - 1]) << i;
}

constexpr Cycles kOffered = 1000;

struct Injected {
  Cycles delivered = 0, stream_ended = 0;
  std::uint64_t handled = 0;
};

/// A stream from PE 0 to PE 3 that takes every slot of the link east of router 1 as soon as it is free, and one packet
/// from PE 1 to PE 2.
Injected inject_into_stream(std::uint32_t patience) {
  MachineDescription::Torus parameters;
  parameters.buffer_packets = 2;
  parameters.patience_cycles = patience;
  TorusDriver driver(8, 1, parameters);
  Injected result;
  driver.on_delivery = [&](const auto& delivery) {
    (delivery.source == 1 ? result.delivered : result.stream_ended) = delivery.delivered;
  };
  for (unsigned i = 0; i < 2000; ++i) driver.send(0, 3, 4, 0);
  driver.send(1, 2, 4, kOffered);
  result.handled = driver.run();
  return result;
}

TEST(TorusArbitration, WithoutPatienceAStreamStarvesAnInjector) {
  const Injected result = inject_into_stream(1'000'000'000);
  EXPECT_GT(result.stream_ended, 5000U);
  EXPECT_GT(result.delivered, result.stream_ended);
}

TEST(TorusArbitration, NobodyWaitsForEver) {
  constexpr Cycles kPatience = 64;
  // A slot is taken for the way of the head (4), the flits (4) and the news of its being free (1).
  constexpr Cycles kSlot = 4 + 4 + 1;
  // Router 1 looks when a slot comes free, so it raises the line up to kSlot late; router 0 sees that 8 links later.
  // At most two packets are then in front of router 1; each goes within kSlot, and kSlot later both slots are free.
  constexpr Cycles kBound = kPatience + 1 + kSlot + 8 + 2 * kSlot + kSlot;
  constexpr Cycles kWay = 2 * 4 + 3;
  const Injected result = inject_into_stream(kPatience);
  EXPECT_GT(result.delivered, kOffered + kPatience + kWay) << "the stream is to starve it until then";
  EXPECT_LE(result.delivered, kOffered + kBound + kWay);
  EXPECT_GT(result.stream_ended, 5000U) << "and to go on";
}

TEST(TorusArbitration, NothingHappensForItWhereNobodyStarves) {
  const auto handled = [](std::uint32_t patience) {
    MachineDescription::Torus parameters;
    parameters.patience_cycles = patience;
    TorusDriver driver(4, 4, parameters);
    for (unsigned i = 0; i < 2000; ++i) driver.send(i % 16, i * 7 % 16, 4, i);
    return driver.run();
  };
  EXPECT_EQ(handled(64), handled(1'000'000'000));
}

}  // namespace

}  // namespace torolux::test
