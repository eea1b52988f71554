// SPDX-License-Identifier: MIT
// Machines by chance under records that wander until they die: every record comes home, and the same machine does the
// same to the last event. The torus alone under overload, with the smallest buffers, errors and delays: it never locks.
#include <gtest/gtest.h>

#include "emulator/traffic/pattern.hpp"
#include "emulator/traffic/traffic.hpp"
#include "tests/soak/random_machine.hpp"
#include "tests/unit/emulator/machine/wanderers.hpp"

namespace torolux::test {
namespace {

TEST(RandomTraffic, EveryRecordComesHomeTheSameWay) {
  for (std::uint32_t seed = 1; seed <= 300; ++seed) {
    MachineDice dice(seed);
    MachineSetup setup = small_machine(dice.number(1, 7), dice.number(1, 7));
    setup.description = dice.description();
    const std::uint32_t per_pe = dice.number(1, 120);
    const std::uint32_t life = dice.number(1, 25);
    const std::uint32_t slots = dice.chance(2) ? dice.number(1, 4) : dice.number(5, 64);
    setup.description.records.niu_slots = slots;
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + to_text(setup.description, setup.columns, setup.rows) + ", " +
                 std::to_string(per_pe) + " records of life " + std::to_string(life));
    const std::uint64_t records = std::uint64_t{setup.columns} * setup.rows * per_pe;
    std::string first;
    for (int attempt = 0; attempt < 2; ++attempt) {
      setup.threads = attempt == 0 ? 0 : 1;
      CountingHost host(records);
      const MachineOutcome outcome = run(setup, host, wanderers(per_pe, life, slots));
      ASSERT_EQ(host.home(), records);
      std::uint64_t sent = 0;
      std::uint64_t delivered = 0;
      for (const PeFigures& pe : outcome.raw.pes) {
        sent += pe.packets_sent;
        delivered += pe.packets_delivered;
        ASSERT_LE(pe.record_slots_high_water, slots);
      }
      ASSERT_EQ(sent, delivered);
      ASSERT_EQ(sent, records * life) << "one packet for each step of a life";
      if (attempt == 0) first = outcome.figures;
      ASSERT_EQ(outcome.figures, first);
    }
  }
}

/// By chance: short or long packets, the smallest buffers, with and without patience.
TrafficSetup overload(std::uint32_t seed, unsigned columns, unsigned rows, std::string_view pattern) {
  MachineDice dice(seed);
  TrafficSetup setup;
  setup.columns = columns;
  setup.rows = rows;
  setup.pattern = pattern;
  setup.rate = pattern == "hotspot" ? std::min(1.0, 3.0 / (columns * rows)) : 0.7;
  setup.packet_flits = dice.number(1, 20);
  setup.seed = seed;
  // All packets count: those made after a while might, beyond saturation, all be made after the end.
  setup.warm_up = 0;
  setup.cycles = 10000;
  setup.machine.torus.buffer_packets = 2;
  setup.machine.torus.slot_return_cycles = dice.number(1, 20);
  setup.machine.torus.patience_cycles = dice.chance(2) ? dice.number(1, 50) : 1000;
  return setup;
}

/// All patterns, errors and delays on one torus. Returns the links that packets have crossed.
std::uint64_t overload_all_ways(std::uint32_t& seed, unsigned columns, unsigned rows) {
  std::uint64_t hops = 0;
  for (const std::string_view pattern : traffic_pattern_names()) {
    if (pattern == "transpose" && columns != rows) continue;
    if (pattern == "tornado" && columns < 3 && rows < 3) continue;
    for (const double errors : {0.0, 0.1, 0.5}) {
      for (const std::uint32_t jitter : {0U, 20U}) {
        TrafficSetup setup = overload(++seed, columns, rows, pattern);
        setup.machine.torus.link_error_rate = errors;
        setup.machine.jitter = {.seed = jitter == 0 ? 0 : seed, .cycles = jitter};
        SCOPED_TRACE(std::string(pattern) + ", " + to_text(setup.machine, columns, rows));
        const TrafficFigures figures = run_traffic(setup);
        EXPECT_GT(figures.packets, 0U);
        hops += figures.packet_hops;
      }
    }
  }
  return hops;
}

/// run_traffic throws where it locks, and ends only when all packets that count have arrived. Tori of every size in
/// turn, until packets have crossed 10^8 links.
TEST(RandomTraffic, RingsOfEverySizeNeverLock) {
  constexpr std::uint64_t kHops = 100'000'000;
  std::uint32_t seed = 0;
  std::uint64_t hops = 0;
  while (hops < kHops && !HasFailure()) {
    for (const auto& [columns, rows] : {std::pair(1U, 2U),
                                        {1U, 3U},
                                        {1U, 5U},
                                        {1U, 8U},
                                        {7U, 1U},
                                        {16U, 1U},
                                        {2U, 2U},
                                        {2U, 3U},
                                        {5U, 2U},
                                        {2U, 8U},
                                        {3U, 3U},
                                        {3U, 5U},
                                        {5U, 5U},
                                        {5U, 8U},
                                        {8U, 8U}}) {
      hops += overload_all_ways(seed, columns, rows);
    }
  }
  std::printf("%u runs, packets crossed %llu links\n", seed, static_cast<unsigned long long>(hops));
}

}  // namespace
}  // namespace torolux::test
