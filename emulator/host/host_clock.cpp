// SPDX-License-Identifier: MIT
// The host's clock: whole cycles and an exact rest.
#include "emulator/host/host_clock.hpp"

#include <cmath>

#include "emulator/errors.hpp"

namespace torolux {

namespace {
__extension__ using Wide = unsigned __int128;

/// Far enough from the greatest number for whatever others add: events' delays, waits of PEs.
constexpr Cycles kMostCycles = Cycles{1} << 62U;
}  // namespace

HostClock::HostClock(const MachineDescription& machine)
    : cost_{},
      pe_hertz_(static_cast<std::uint64_t>(std::llround(machine.processor.clock_hertz))),
      host_hertz_(static_cast<std::uint64_t>(std::llround(machine.host.clock_hertz))) {
  const std::uint64_t factor = machine.ideal.host ? 0 : machine.host.cost_factor;
  for (std::size_t i = 0; i < kHostWorks; ++i) cost_[i] = factor * machine.host.cycles[i];
}

void HostClock::wait_until(Cycles time) {
  if (time <= now()) return;
  idle_ += time - now();
  cycles_ = time;
  part_ = 0;
}

void HostClock::work(HostWork what, std::uint64_t items) {
  const auto kind = static_cast<std::size_t>(what);
  const std::uint64_t own = cost_[kind] * items;
  items_[kind] += items;
  own_cycles_[kind] += own;
  const Wide sum = Wide{own} * pe_hertz_ + part_;
  const Wide whole = cycles_ + sum / host_hertz_;
  if (whole > kMostCycles) {
    throw MachineFailure(
        "the host's work takes its clock beyond 2^62 cycles of the PEs: a faster host.clock_hertz, or "
        "a smaller host.cost_factor, is needed");
  }
  cycles_ = static_cast<Cycles>(whole);
  part_ = static_cast<std::uint64_t>(sum % host_hertz_);
}

}  // namespace torolux
