// SPDX-License-Identifier: MIT
// The torus alone: routes, latency by hand, order, slots, rings of every awkward size, deadlock without the bubble.
#include "emulator/torus/torus.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "emulator/errors.hpp"
#include "tests/unit/emulator/torus/torus_driver.hpp"

namespace torolux::test {

namespace {

TEST(TorusShape, RoutesAreShortestAndDimensionOrdered) {
  for (const auto& [columns, rows] : {std::pair(1U, 1U), {1U, 7U}, {2U, 5U}, {3U, 3U}, {4U, 4U}, {5U, 8U}}) {
    const TorusShape shape(columns, rows);
    for (unsigned from = 0; from < shape.routers(); ++from) {
      for (unsigned to = 0; to < shape.routers(); ++to) {
        unsigned at = from;
        unsigned hops = 0;
        bool turned = false;
        for (Port port = shape.route(at, to); port != Port::local; port = shape.route(at, to)) {
          const bool along_y = port == Port::south || port == Port::north;
          EXPECT_FALSE(turned && !along_y) << "back to x after y";
          turned = along_y;
          at = shape.neighbour(at, port);
          EXPECT_EQ(shape.route_on(port, shape.place(at), shape.place(to)), shape.route(at, to));
          ASSERT_LE(++hops, columns + rows);
        }
        EXPECT_EQ(at, to);
        EXPECT_EQ(hops, shape.hops(from, to));
        const auto ring = [](unsigned a, unsigned b, unsigned k) { return std::min((a + k - b) % k, (b + k - a) % k); };
        EXPECT_EQ(hops, ring(from % columns, to % columns, columns) + ring(from / columns, to / columns, rows));
      }
    }
  }
}

TEST(TorusShape, LinksGoBothWays) {
  const TorusShape shape(3, 4);
  for (unsigned router = 0; router < shape.routers(); ++router) {
    for (const Port port : {Port::east, Port::west, Port::south, Port::north}) {
      EXPECT_EQ(shape.neighbour(shape.neighbour(router, port), opposite(port)), router);
    }
  }
}

/// Mean hops and greatest channel load per unit injection, uniform traffic to others, along the model's own routes.
TEST(TorusShape, MeetsTheTheoryOfUniformTraffic) {
  // notes of the design (exact): k, gamma, mean hops. For odd and even k alike the parity rule balances the ties.
  struct Row {
    unsigned k;
    double gamma, hops;
  };
  for (const Row& row : {Row{4, 0.5333, 2.133}, Row{5, 0.625, 2.5}, Row{8, 1.0159, 4.063}, Row{16, 2.0078, 8.03}}) {
    const TorusShape shape(row.k, row.k);
    std::map<std::pair<unsigned, Port>, double> load;
    double hops = 0;
    const unsigned n = shape.routers();
    for (unsigned from = 0; from < n; ++from) {
      for (unsigned to = 0; to < n; ++to) {
        for (unsigned at = from; at != to; at = shape.neighbour(at, shape.route(at, to))) {
          load[{at, shape.route(at, to)}] += 1.0 / (n - 1);
          hops += 1.0 / (n - 1) / n;
        }
      }
    }
    double most = 0;
    for (const auto& [channel, value] : load) most = std::max(most, value);
    EXPECT_NEAR(most, row.gamma, 0.0005) << row.k;  // half a unit of the table's last digit
    EXPECT_NEAR(hops, row.hops, 0.005) << row.k;
  }
}

TEST(Torus, ZeroLoadLatencyByHand) {
  MachineDescription::Torus parameters;
  parameters.router_cycles = 3;
  parameters.link_cycles = 2;
  for (const std::uint32_t flits : {1U, 5U, 65U}) {
    for (unsigned to = 0; to < 20; ++to) {
      TorusDriver driver(5, 4, parameters);
      std::vector<TorusDriver::Delivery> seen;
      driver.on_delivery = [&](const auto& delivery) { seen.push_back(delivery); };
      driver.send(7, to, flits, 100);
      driver.run();
      ASSERT_EQ(seen.size(), 1U);
      const unsigned hops = driver.torus().shape().hops(7, to);
      EXPECT_EQ(seen[0].hops, hops);
      EXPECT_EQ(seen[0].delivered - 100, (hops + 1) * (3U + 2U) + flits - 1);
      EXPECT_EQ(driver.torus().packet_figures().hops, hops);
    }
  }
}

TEST(Torus, OnePacketAtATimeOnALinkAndAtTheNiu) {
  // Two packets of 8 flits from the same PE at once: the second is 8 cycles later. Two from both neighbours: likewise.
  TorusDriver driver(4, 4, {});
  std::vector<Cycles> at;
  driver.on_delivery = [&](const auto& delivery) { at.push_back(delivery.delivered); };
  driver.send(0, 1, 8, 0);
  driver.send(0, 1, 8, 0);
  driver.run();
  EXPECT_THAT(at, testing::ElementsAre(2 * 4 + 7, 2 * 4 + 7 + 8));
  at.clear();
  driver.send(4, 5, 8, 1000);
  driver.send(6, 5, 8, 1000);
  driver.run();
  EXPECT_THAT(at, testing::ElementsAre(1000 + 2 * 4 + 7, 1000 + 2 * 4 + 7 + 8));
}

/// Bursts between random pairs on a torus with buffers as small as they may be. Returns packets not delivered.
std::size_t soak(unsigned columns, unsigned rows, const MachineDescription::Torus& parameters, std::uint32_t seed,
                 std::uint32_t delay = 0) {
  TorusDriver driver(columns, rows, parameters, delay);
  std::map<std::pair<unsigned, unsigned>, std::uint32_t> last;
  std::size_t left = 0;
  driver.on_delivery = [&](const TorusDriver::Delivery& delivery) {
    --left;
    auto [place, first] = last.try_emplace({delivery.source, delivery.destination}, delivery.number);
    EXPECT_TRUE(first || place->second < delivery.number) << "packets of a pair overtook each other";
    place->second = delivery.number;
    EXPECT_EQ(delivery.hops, driver.torus().shape().hops(delivery.source, delivery.destination));
  };
  std::minstd_rand random(seed);
  const unsigned pes = columns * rows;
  for (unsigned burst = 0; burst < 20; ++burst) {
    for (unsigned i = 0; i < 100 * pes; ++i) {
      const auto from = static_cast<unsigned>(random() % pes);
      // Half of them far away along the rings: that is what fills them.
      const auto to = static_cast<unsigned>(i % 2 == 0 ? random() % pes : (from + pes / 2) % pes);
      driver.send(from, to, 1 + static_cast<std::uint32_t>(random() % 8), driver.now() + random() % 200);
      ++left;
    }
    driver.run(driver.now() + 300);
    driver.torus().check_slots();
  }
  driver.run();
  driver.torus().check_slots();
  EXPECT_EQ(driver.torus().packets_inside(), left);
  for (const RouterFigures& router : driver.torus().router_figures(driver.now())) {
    for (const LinkFigures& link : router.links) EXPECT_LE(link.queue_high_water, parameters.buffer_packets);
  }
  return left;
}

TEST(Torus, RingsOfEverySizeDrainWithTheSmallestBuffers) {
  MachineDescription::Torus parameters;
  parameters.buffer_packets = 2;
  std::uint32_t seed = 1;
  for (const auto& [columns, rows] : {std::pair(1U, 1U),
                                      {1U, 2U},
                                      {2U, 2U},
                                      {1U, 3U},
                                      {1U, 5U},
                                      {1U, 8U},
                                      {8U, 1U},
                                      {2U, 5U},
                                      {3U, 3U},
                                      {5U, 3U},
                                      {4U, 4U},
                                      {8U, 8U}}) {
    EXPECT_EQ(soak(columns, rows, parameters, seed++), 0U) << columns << "x" << rows;
  }
}

TEST(Torus, DrainsWithLinkErrorsAndDelays) {
  // soak() and the driver see to it that every packet arrives once, in order, and that no slot is lost.
  MachineDescription::Torus parameters;
  parameters.buffer_packets = 2;
  std::uint32_t seed = 7;
  for (const auto& [columns, rows] : {std::pair(5U, 3U), {1U, 8U}, {2U, 4U}}) {
    for (const double rate : {0.01, 0.1, 0.5}) {
      for (const std::uint32_t jitter : {0U, 50U}) {
        parameters.link_error_rate = rate;
        parameters.slot_return_cycles = jitter == 0 ? 1 : 17;
        EXPECT_EQ(soak(columns, rows, parameters, seed++, jitter), 0U) << columns << "x" << rows << ", " << rate;
      }
    }
  }
}

TEST(Torus, WithoutTheBubbleARingLocks) {
  MachineDescription::Torus parameters;
  parameters.buffer_packets = 2;
  parameters.bubble = false;
  EXPECT_GT(soak(1, 8, parameters, 3), 0U);
}

TEST(Torus, ErrorsCostRetriesAndNothingElse) {
  MachineDescription::Torus parameters;
  parameters.link_error_rate = 0.5;
  parameters.retry_cycles = 8;
  TorusDriver driver(8, 1, parameters);
  Cycles total = 0;
  std::uint64_t crossed = 0;
  driver.on_delivery = [&](const auto& delivery) {
    total += delivery.delivered - delivery.sent;
    crossed += delivery.hops;
  };
  constexpr unsigned kPackets = 2000;
  for (unsigned i = 0; i < kPackets; ++i) driver.send(0, 4, 4, i * 100'000);
  driver.run();
  const std::uint64_t retries = driver.torus().link_retries();
  EXPECT_EQ(crossed, 4U * kPackets);
  EXPECT_EQ(total, kPackets * (5 * 4 + 3U) + retries * (4 + 8));
  // Mean one retry per crossing at rate 0.5, variance 2: five standard deviations of the sum over 8000.
  EXPECT_NEAR(static_cast<double>(retries), 8000, 5 * std::sqrt(2 * 8000.0));
}

TEST(Torus, TheReportNamesStuckRouters) {
  MachineDescription::Torus parameters;
  TorusDriver driver(4, 1, parameters);
  for (int i = 0; i < 30; ++i) driver.send(0, 1, 65, 0);
  driver.run(10);
  EXPECT_THAT(driver.torus().report(5), testing::HasSubstr("router 0: packets wait, 29 from local for east"));
}

}  // namespace

}  // namespace torolux::test
