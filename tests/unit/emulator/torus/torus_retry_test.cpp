// SPDX-License-Identifier: MIT
// A packet that fails its CRC once, followed by hand: forwarded before it is known to be bad, dropped where its tail
// finds it, sent again.
#include <gtest/gtest.h>

#include "tests/unit/emulator/torus/torus_driver.hpp"

namespace torolux::test {

namespace {

constexpr std::uint32_t kFlits = 8;
constexpr Cycles kBegin = 100;

struct Followed {
  Cycles delivered = 0;
  std::uint64_t dropped_by_niu = 0;
  std::uint64_t wasted_hops = 0;
  std::uint64_t wasted_flits_at_1 = 0;  ///< over the link east of router 1
};

/// The number of a packet that is spoilt once on its first link, and on none of the next two.
std::uint32_t spoilt_once(const MachineDescription::Torus& parameters) {
  LinkFaults faults(parameters);
  Block block{};
  block.bytes = 16;
  for (block.number = 0;; ++block.number) {
    block.hops = 0;
    if (faults.bad_copies(block) != 1) continue;
    block.hops = 1;
    if (faults.bad_copies(block) != 0) continue;
    block.hops = 2;
    if (faults.bad_copies(block) == 0) return static_cast<std::uint32_t>(block.number);
  }
}

/// From PE 0 over 3 links to PE 3, offered at kBegin; the output east of router 1 is taken from kBegin on for
/// `busy_flits` cycles (0: not at all).
Followed follow(std::uint32_t busy_flits) {
  MachineDescription::Torus parameters;  // 3 cycles for a router, 1 for a link, 8 until the retry
  parameters.link_error_rate = 0.3;
  parameters.buffer_packets = 2;
  TorusDriver driver(8, 1, parameters);
  driver.set_next_number(0, spoilt_once(parameters));
  Followed result;
  driver.on_delivery = [&](const TorusDriver::Delivery& delivery) {
    if (delivery.source == 0) result.delivered = delivery.delivered;
  };
  driver.send(0, 3, kFlits, kBegin);
  if (busy_flits != 0) {
    // A packet that no link spoils on its only hop.
    LinkFaults faults(parameters);
    Block other{};
    other.bytes = 16;
    other.number = std::uint64_t{1} << 32U;
    while (faults.bad_copies(other) != 0) ++other.number;
    driver.set_next_number(1, static_cast<std::uint32_t>(other.number));
    driver.send(1, 2, busy_flits, kBegin);
  }
  for (Cycles now = kBegin; now < kBegin + 100; ++now) {
    driver.run(now);
    driver.torus().check_slots();
  }
  driver.run();
  result.dropped_by_niu = driver.dropped();
  result.wasted_hops = driver.torus().packet_figures().wasted_hops;
  const auto figures = driver.torus().router_figures(driver.now());
  result.wasted_flits_at_1 = figures[1].links[index_of(Port::east)].wasted_flits;
  EXPECT_EQ(driver.torus().link_retries(), 1U);
  EXPECT_EQ(figures[0].links[index_of(Port::east)].wasted_flits, kFlits);
  EXPECT_EQ(figures[0].links[index_of(Port::east)].flits, kFlits);
  EXPECT_EQ(figures[0].links[index_of(Port::east)].busy, kFlits + 8 + kFlits);
  EXPECT_EQ(driver.pool().in_use(), 0U);
  return result;
}

// The bad copy's head is at router 1 at 104, its tail at 111. The good copy leaves at 100 + 8 flits + 8 cycles = 116.

TEST(TorusRetry, WhereNothingIsInTheWayTheBadCopyGoesAllTheWay) {
  const Followed followed = follow(0);
  EXPECT_EQ(followed.delivered, 116 + 4 * 4 + kFlits - 1);
  EXPECT_EQ(followed.dropped_by_niu, 1U);
  EXPECT_EQ(followed.wasted_hops, 3U);
  EXPECT_EQ(followed.wasted_flits_at_1, kFlits);
}

TEST(TorusRetry, WhereItWaitsTheBadCopyIsDroppedWhenItsTailComes) {
  const Followed followed = follow(30);
  // The good copy comes at 120 and waits until 130; three routers and two links are left.
  EXPECT_EQ(followed.delivered, 130 + 3 * 4 + kFlits - 1);
  EXPECT_EQ(followed.dropped_by_niu, 0U);
  EXPECT_EQ(followed.wasted_hops, 1U);
  EXPECT_EQ(followed.wasted_flits_at_1, 0U);
}

TEST(TorusRetry, TheLastCycleDecides) {
  // Free at 110, before the tail: passed on. Free at 111, when the tail has been seen: dropped.
  EXPECT_EQ(follow(10).wasted_hops, 3U);
  EXPECT_EQ(follow(11).wasted_hops, 1U);
  // Neither holds up the good copy.
  for (const std::uint32_t busy : {10U, 11U}) EXPECT_EQ(follow(busy).delivered, 116 + 4 * 4 + kFlits - 1);
}

TEST(TorusRetry, NobodySendsAgainBeforeTheAnswerCanHaveCome) {
  MachineDescription::Torus parameters;
  parameters.link_error_rate = 0.3;
  parameters.retry_cycles = 1;
  parameters.link_cycles = 20;
  TorusDriver driver(8, 1, parameters);
  driver.set_next_number(0, spoilt_once(parameters));
  Cycles delivered = 0;
  driver.on_delivery = [&](const TorusDriver::Delivery& delivery) { delivered = delivery.delivered; };
  driver.send(0, 3, kFlits, 0);
  driver.run();
  // The tail leaves at 8, is through link and router 23 cycles later, and the answer over the link after 20 more.
  EXPECT_EQ(delivered, 8 + 23 + 20 + 4 * 23 + kFlits - 1);
}

}  // namespace

}  // namespace torolux::test
