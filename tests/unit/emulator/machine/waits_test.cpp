// SPDX-License-Identifier: MIT
// Where a PE's time goes: busy cycles, and waits by their reasons, add up to the virtual time.
#include <gtest/gtest.h>

#include <numeric>

#include "tests/unit/emulator/machine/wanderers.hpp"

namespace torolux::test {

namespace {

TEST(Waits, AddUpWithBusyCycles) {
  ListeningHost host(1);
  host.at_start = [](HostPort& port) { port.send_message(1, kGo, {}); };
  NativeOptions options;
  options.cycles_per_hint = 10;
  const MachineOutcome outcome = run(
      small_machine(2, 1), host,
      [](Niu& niu, NativeClock& clock) {
        if (niu.pe() == 0) return;
        niu.receive();
        niu.enter_phase<protocol::Phase::shade>();
        clock.spend(1000);
        niu.leave_phase<protocol::Phase::shade>();
        niu.send(static_cast<protocol::MessageKind>(kDone));
        sleep_for_ever(niu);
      },
      options);
  const PeFigures& pe = outcome.raw.pes[1];
  EXPECT_EQ(pe.busy_cycles, 10U + 1000 + 10 + 10);
  EXPECT_EQ(pe.busy_cycles + pe.idle_cycles(), outcome.raw.now);
  EXPECT_EQ(pe.phase_cycles[static_cast<std::size_t>(protocol::Phase::shade)], 1000U);
  EXPECT_EQ(outcome.raw.pes[0].busy_cycles + outcome.raw.pes[0].idle_cycles(), outcome.raw.now);
}

Cycles waited_for(const PeFigures& pe, WaitReason reason) {
  return pe.waits[static_cast<std::size_t>(reason)];
}

TEST(Waits, AreChargedToTheirReasons) {
  // PE 0 waits for the host, then for places in queues of one each; PE 1 sleeps until the end.
  ListeningHost host(8);
  host.at_start = [](HostPort& port) { port.send_message(0, kGo, {}); };
  MachineSetup setup = small_machine(2, 1);
  setup.description.torus.send_queue_packets = 1;
  setup.description.torus.flit_bytes = 1;
  setup.description.bus.send_queue_messages = 1;
  NativeOptions options;
  options.cycles_per_hint = 1;
  const auto program = [](Niu& niu, NativeClock& clock) {
    if (niu.pe() != 0) return;
    set_test_slots(niu, 64);
    niu.receive();
    for (std::uint16_t i = 0; i < 8; ++i) send_one(niu, 0, i);
    for (int i = 0; i < 8; ++i) niu.send(static_cast<protocol::MessageKind>(kDone));
    niu.enter_phase<protocol::Phase::shade>();
    clock.spend(100);
  };
  const MachineOutcome outcome = run(setup, host, program, options);
  const PeFigures& busy = outcome.raw.pes[0];
  for (const WaitReason reason : {WaitReason::arrivals, WaitReason::torus_place, WaitReason::bus_place}) {
    EXPECT_GT(waited_for(busy, reason), 0U) << static_cast<int>(reason);
  }
  // Two packets leave at once, one into the torus; each of the others waits 80 flits, less its HINT's own cycle.
  EXPECT_GE(waited_for(busy, WaitReason::torus_place), 6U * 79);
  EXPECT_GE(busy.phase_cycles[static_cast<std::size_t>(protocol::Phase::shade)], 100U) << "open at the end";
  const PeFigures& other = outcome.raw.pes[1];
  EXPECT_EQ(std::accumulate(other.waits.begin(), other.waits.end(), Cycles{0}), 0U);
  EXPECT_EQ(other.busy_cycles + other.idle_at_end, outcome.raw.now);
  EXPECT_EQ(busy.busy_cycles + busy.idle_cycles(), outcome.raw.now);
}

}  // namespace

}  // namespace torolux::test
