// SPDX-License-Identifier: MIT
// Packets that go ahead of time where nobody is in their way: everything happens at the same times as without.
#include <gtest/gtest.h>

#include <random>
#include <tuple>

#include "tests/unit/emulator/torus/torus_driver.hpp"

namespace torolux::test {

namespace {

using Delivered = std::tuple<Cycles, unsigned, unsigned, std::uint32_t, std::uint32_t>;

/// A torus, and what has left it, in order.
class Watched {
 public:
  Watched(unsigned columns, unsigned rows, const MachineDescription::Torus& parameters)
      : driver(columns, rows, parameters) {
    driver.on_delivery = [this](const TorusDriver::Delivery& one) {
      delivered.emplace_back(one.delivered, one.source, one.destination, one.number, one.hops);
    };
  }

  TorusDriver driver;
  std::vector<Delivered> delivered;
};

/// By chance: rings of any length, the smallest buffers, short and long packets, between one packet in flight and far
/// more than the torus can take.
class Load {
 public:
  explicit Load(std::uint32_t seed) : random_(seed) {
    columns = number(1, 20);
    rows = number(columns == 1 ? 2 : 1, 8);
    parameters.buffer_packets = number(2, 5);
    parameters.router_cycles = number(1, 4);
    parameters.link_cycles = number(1, 3);
    parameters.slot_return_cycles = number(1, 9);
    parameters.patience_cycles = number(0, 3) == 0 ? number(1, 9) : 64;
    most_flits_ = number(1, 30);
    gap_ = number(0, 6) == 0 ? 1 : number(1, 100);
    crowded_ = number(0, 2) == 0;
    if (crowded_) gap_ = most_flits_ / 2 + 1;
  }
  unsigned number(unsigned least, unsigned most) {
    return std::uniform_int_distribution<unsigned>(least, most)(random_);
  }
  /// The same to both.
  void send(Watched& one, Watched& other, unsigned packets) {
    Cycles when = 0;
    for (unsigned i = 0; i < packets; ++i) {
      when += number(0, gap_);
      const unsigned to_row = number(0, rows - 1);
      const bool inside = crowded_ && number(0, 7) != 0;
      const unsigned from = inside ? number(0, rows - 1) * columns : number(0, columns * rows - 1);
      const unsigned to = crowded_ ? to_row * columns : to_row * columns + number(0, columns - 1);
      const unsigned flits = number(1, most_flits_);
      for (TorusDriver* driver : {&one.driver, &other.driver}) driver->send(from, to, flits, when);
    }
  }

  unsigned columns, rows;
  MachineDescription::Torus parameters;

 private:
  std::minstd_rand random_;
  unsigned most_flits_, gap_;
  bool crowded_;  // most packets stay in one column, the others turn into it
};

TEST(TorusAdvance, ChangesNothingButTheNumberOfEvents) {
  std::uint64_t events = 0;
  std::uint64_t events_without = 0;
  for (std::uint32_t seed = 1; seed <= 3000; ++seed) {
    Load load(seed);
    Watched one(load.columns, load.rows, load.parameters);
    Watched other(load.columns, load.rows, load.parameters);
    other.driver.torus().keep_to_time();
    load.send(one, other, 300);
    SCOPED_TRACE("seed " + std::to_string(seed));
    // Looking at links in between takes back what is ahead.
    for (Cycles look = 0; look < 4000; look += load.number(1, 400)) {
      events += one.driver.run(look);
      events_without += other.driver.run(look);
      ASSERT_EQ(one.driver.torus().router_figures(look), other.driver.torus().router_figures(look)) << look;
    }
    events += one.driver.run();
    events_without += other.driver.run();
    ASSERT_EQ(one.delivered, other.delivered);
    ASSERT_EQ(one.delivered.size(), 300U);
    const Cycles end = other.driver.now();
    ASSERT_EQ(one.driver.now(), end);
    ASSERT_EQ(one.driver.torus().router_figures(end), other.driver.torus().router_figures(end));
    ASSERT_EQ(one.driver.torus().packet_figures(), other.driver.torus().packet_figures());
    one.driver.torus().check_slots();
  }
  EXPECT_LT(events, events_without);
}

// From PE 0 to PE 10 of a ring of 32: the arrival there, its arbitration, and what there is of every packet.
TEST(TorusAdvance, AloneItNeedsNoEventsOnItsWay) {
  Watched near(32, 1, {});
  near.driver.send(0, 1, 8, 100);
  Watched far(32, 1, {});
  far.driver.send(0, 10, 8, 100);
  EXPECT_EQ(far.driver.run(), near.driver.run());
  EXPECT_EQ(far.delivered.at(0), Delivered(100 + 11 * 4 + 7, 0, 10, 0, 10));
}

/// One from PE 0 past PE 3, offered at 100, and one from PE 3 for the same link, on a ring.
std::vector<Delivered> two_on_a_link(Cycles other_offered) {
  Watched ring(16, 1, {});
  ring.driver.send(0, 6, 8, 100);
  ring.driver.send(3, 6, 8, other_offered);
  ring.driver.run();
  return ring.delivered;
}

// The first is on its way, ahead of time, when PE 3 offers the other in the same cycle in which it comes there; the
// older one goes first. A cycle earlier the other goes first, and the first, which comes a cycle later, waits.
TEST(TorusAdvance, IsTakenBackWhereSomebodyComesInBetween) {
  EXPECT_EQ(two_on_a_link(112),
            (std::vector{Delivered(100 + 7 * 4 + 7, 0, 6, 0, 6), Delivered(112 + 8 + 4 * 4 + 7, 3, 6, 0, 3)}));
  EXPECT_EQ(two_on_a_link(111),
            (std::vector{Delivered(111 + 4 * 4 + 7, 3, 6, 0, 3), Delivered(111 + 8 + 4 * 4 + 7, 0, 6, 0, 6)}));
}

// A stream in the first column leaves PE 32, in the second row, no way into its ring; when that has waited long enough,
// nobody enters the ring anywhere. A packet that is on its way there, and to turn into the ring far from the stream, is
// held back as well, although it had gone ahead before, and nobody asks for the links that it takes.
TEST(TorusAdvance, WhoIsToEnterARingWaitsForThoseWhoStarve) {
  MachineDescription::Torus parameters;
  parameters.buffer_packets = 2;
  bool was_held_back = false;
  for (Cycles offered = 1000; offered < 1200; ++offered) {
    Watched one(32, 8, parameters);
    Watched other(32, 8, parameters);
    other.driver.torus().keep_to_time();
    for (TorusDriver* driver : {&one.driver, &other.driver}) {
      for (unsigned i = 0; i < 400; ++i) driver->send(0, 3 * 32, 4, 0);
      driver->send(32, 2 * 32, 4, 1000);
      driver->send(5 * 32 + 15, 6 * 32, 4, offered);
      driver->run();
    }
    ASSERT_EQ(one.delivered, other.delivered) << offered;
    for (const auto& [delivered, source, destination, number, hops] : other.delivered) {
      if (source == 5 * 32 + 15) was_held_back |= delivered > offered + 17 * 4 + 3;
    }
  }
  EXPECT_TRUE(was_held_back);
}

}  // namespace

}  // namespace torolux::test
