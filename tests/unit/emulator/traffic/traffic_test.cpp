// SPDX-License-Identifier: MIT
// Synthetic traffic against exact theory (../shared/notes/torus_theory.md gives the same values), fairness beyond
// saturation, and the figures that the torus keeps.
#include "emulator/traffic/traffic.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "emulator/errors.hpp"
#include "emulator/traffic/pattern.hpp"

namespace torolux::test {

namespace {

TrafficSetup traffic(const std::string& pattern, unsigned k, double rate) {
  TrafficSetup setup;
  setup.columns = setup.rows = k;
  setup.pattern = pattern;
  setup.rate = rate;
  return setup;
}

struct Theory {
  std::string pattern;
  unsigned k;
  double ideal;  ///< throughput [flits / node / cycle]; the NIU limits it to 1
  double hops;   ///< mean
};

/// Torus networks, dimension order, packets to others only. Transpose leaves the diagonal out: 8 x mean / 7.
const std::vector<Theory>& theory() {
  static const std::vector<Theory> kTheory = {{"uniform", 4, 1.875, 2.1333},  {"uniform", 5, 1.6, 2.5},
                                              {"uniform", 8, 0.9844, 4.0635}, {"uniform", 16, 0.498, 8.0314},
                                              {"bit-complement", 8, 0.5, 4},  {"transpose", 8, 2 / 7.0, 32 / 7.0},
                                              {"tornado", 8, 1 / 3.0, 6},     {"hotspot", 8, 1 / 63.0, 256 / 63.0}};
  return kTheory;
}

TEST(Traffic, HopsAndLinkLoadsAreTheorys) {
  for (const Theory& row : theory()) {
    TrafficSetup setup = traffic(row.pattern, row.k, 0.1 * std::min(row.ideal, 1.0));
    setup.packet_flits = 1;
    setup.cycles = row.k == 16 ? 20000 : 60000;
    const TrafficFigures figures = run_traffic(setup);
    SCOPED_TRACE(row.pattern + " " + std::to_string(row.k));
    // Packets are independent: five standard deviations of their mean; hops of one vary by less than the diameter / 2.
    const double deviation = 0.5 * row.k / std::sqrt(static_cast<double>(figures.packets));
    EXPECT_NEAR(figures.mean_hops, row.hops, row.pattern == "tornado" ? 0 : 5 * deviation);
    // All links of these are loaded to 1 / ideal at most. The busiest of hundreds carries n flits, n by chance.
    if (row.pattern == "hotspot") continue;  // bound by the ejection, not by a link
    // Transpose: of each row only one packet in eight goes half a ring, and by its parity, all of it one way. So a link
    // carries 4 where theory, which halves such packets, has 3.5.
    const double load = setup.rate * (row.pattern == "transpose" ? 4 : 1 / row.ideal);
    const double noise = 5 * std::sqrt(load / static_cast<double>(*setup.cycles));
    EXPECT_NEAR(figures.max_link_load, load, noise);
    EXPECT_NEAR(figures.accepted, setup.rate, 0.03 * setup.rate);
  }
}

TEST(Traffic, NoThroughputIsAboveTheIdeal) {
  for (const Theory& row : theory()) {
    TrafficSetup setup = traffic(row.pattern, row.k, std::min(1.0, 3 * row.ideal));
    setup.cycles = 5000;
    setup.warm_up = 2000;
    const TrafficFigures figures = run_traffic(setup);
    SCOPED_TRACE(row.pattern + " " + std::to_string(row.k));
    // A packet more may be caught in the time than belongs to it, per node.
    EXPECT_LE(figures.accepted, std::min(row.ideal, 1.0) + setup.packet_flits / 5000.0);
    EXPECT_LE(figures.max_link_load, 1 + setup.packet_flits / 5000.0);
    EXPECT_GE(figures.accepted, 0.25 * std::min(row.ideal, 1.0));
  }
}

TEST(Traffic, IsFairBeyondSaturation) {
  for (const std::string pattern : {"uniform", "tornado", "transpose", "bit-complement", "hotspot"}) {
    for (const std::uint32_t flits : {1U, 4U, 16U}) {
      TrafficSetup setup = traffic(pattern, 8, pattern == "hotspot" ? 0.05 : 0.8);
      setup.packet_flits = flits;
      // A hundred packets of each node at least.
      setup.cycles = pattern == "hotspot" ? 63 * 100 * flits : 4000 + 1000 * flits;
      const TrafficFigures figures = run_traffic(setup);
      EXPECT_LT(figures.accepted, 0.9 * setup.rate) << "is to be beyond saturation";
      const bool even = pattern == "uniform" || pattern == "tornado";
      EXPECT_GE(figures.fairness, even ? 0.8 : 0.2) << pattern << ", " << flits << " flits";
    }
  }
}

TEST(Traffic, IsTheSameEveryTime) {
  TrafficSetup setup = traffic("uniform", 4, 0.6);
  setup.machine.torus.link_error_rate = 0.05;
  setup.machine.jitter.seed = 3;
  const auto values = [&] {
    const TrafficFigures figures = run_traffic(setup);
    return std::vector<double>{figures.accepted,  figures.mean_latency,  figures.p99_latency, figures.max_latency,
                               figures.mean_hops, figures.max_link_load, figures.fairness};
  };
  const std::vector<double> once = values();
  EXPECT_EQ(values(), once);
  setup.seed = 2;
  EXPECT_NE(values(), once);
}

TEST(Traffic, ErrorsAndJitterCostTimeAndNothingElse) {
  TrafficSetup setup = traffic("uniform", 4, 0.05);
  const TrafficFigures ideal = run_traffic(setup);
  setup.machine.torus.link_error_rate = 0.1;
  const TrafficFigures errors = run_traffic(setup);
  EXPECT_EQ(errors.packets, ideal.packets);
  EXPECT_EQ(errors.mean_hops, ideal.mean_hops);
  // One hop in nine is tried once more: 4 flits and 8 cycles. Queueing comes on top.
  EXPECT_GT(errors.mean_latency, ideal.mean_latency + 0.9 * 2.13 * (4 + 8) / 9);
}

TEST(Traffic, LatencyAtZeroLoadIsExact) {
  // One packet in a hundred thousand cycles from each of two nodes.
  TrafficSetup setup;
  setup.columns = 1;
  setup.rows = 2;
  setup.pattern = "bit-complement";
  setup.packet_flits = 8;
  setup.rate = 8e-4;
  const TrafficFigures figures = run_traffic(setup);
  EXPECT_EQ(figures.max_latency, 2 * 4 + 7);
  EXPECT_EQ(figures.mean_latency, 2 * 4 + 7);
}

TEST(Traffic, FindsTheDeadlockThatTheBubblePrevents) {
  TrafficSetup setup = traffic("uniform", 8, 1);
  setup.columns = 1;
  setup.machine.torus.buffer_packets = 2;
  EXPECT_NO_THROW(run_traffic(setup));
  setup.machine.torus.bubble = false;
  try {
    run_traffic(setup);
    FAIL() << "no deadlock";
  } catch (const MachineFailure& failure) {
    EXPECT_THAT(failure.what(), testing::HasSubstr("deadlock at cycle"));
    EXPECT_THAT(failure.what(), testing::HasSubstr("router 0: packets wait"));
  }
}

TEST(Traffic, RefusesWhatDoesNotFit) {
  const auto with = [](const std::string& pattern, unsigned columns, unsigned rows, double rate) {
    TrafficSetup setup = traffic(pattern, columns, rate);
    setup.rows = rows;
    run_traffic(setup);
  };
  EXPECT_THROW(with("uniform", 1, 1, 0.1), InputError);
  EXPECT_THROW(with("uniform", 4, 4, 0), InputError);
  EXPECT_THROW(with("uniform", 4, 4, 1.5), InputError);
  EXPECT_THROW(with("uniform", 4, 4, std::nan("")), InputError);
  EXPECT_THROW(with("transpose", 2, 3, 0.1), InputError);
  EXPECT_THROW(with("tornado", 2, 2, 0.1), InputError);
  EXPECT_THROW(with("rain", 4, 4, 0.1), UsageError);
  EXPECT_NO_THROW(with("tornado", 1, 3, 0.1));
  EXPECT_NO_THROW(with("bit-complement", 3, 3, 0.1));
}

TEST(TrafficPattern, UniformIsEvenAndLeavesTheSenderOut) {
  for (const bool to_itself : {false, true}) {
    const auto pattern = make_traffic_pattern("uniform", TorusShape(4, 2), to_itself);
    std::vector<int> count(8, 0);
    for (std::uint32_t i = 0; i < 800; ++i) {
      ++count[pattern->destination(3, i * 5'368'709U)];  // evenly over 32 bits
    }
    for (unsigned to = 0; to < 8; ++to) {
      EXPECT_NEAR(count[to], to_itself ? 100 : (to == 3 ? 0 : 114), 2) << to;
    }
  }
}

}  // namespace

}  // namespace torolux::test
