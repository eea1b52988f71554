// SPDX-License-Identifier: MIT
// The hash of all events: the same for equal runs, another as soon as anything happens at another time.
#include <gtest/gtest.h>

#include "tests/unit/emulator/machine/wanderers.hpp"

namespace torolux::test {
namespace {

std::uint64_t trace_of(const MachineSetup& setup) {
  CountingHost host(9 * 40);
  return run(setup, host, wanderers(40, 12, 8)).raw.trace_hash;
}

TEST(TraceHash, IsTheSameForEqualRuns) {
  const MachineSetup setup = small_machine(3, 3);
  const std::uint64_t first = trace_of(setup);
  EXPECT_NE(first, 0U);
  EXPECT_EQ(trace_of(setup), first);
}

TEST(TraceHash, TellsRunsApart) {
  const std::uint64_t first = trace_of(small_machine(3, 3));
  MachineSetup slower = small_machine(3, 3);
  ++slower.description.torus.link_cycles;
  EXPECT_NE(trace_of(slower), first);
  MachineSetup bus = small_machine(3, 3);
  ++bus.description.host.cycles[0];
  EXPECT_NE(trace_of(bus), first);
  MachineSetup faults = small_machine(3, 3);
  faults.description.torus.link_error_rate = 0.01;
  EXPECT_NE(trace_of(faults), first);
}

}  // namespace
}  // namespace torolux::test
