// SPDX-License-Identifier: MIT
// Machines by chance under records that wander until they die: every record comes home, and the same machine does the
// same to the last event.
#include <gtest/gtest.h>

#include "tests/soak/random_machine.hpp"
#include "tests/unit/emulator/wanderers.hpp"

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
      const Outcome outcome = run(setup, host, wanderers(per_pe, life, slots));
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

}  // namespace
}  // namespace torolux::test
