// SPDX-License-Identifier: MIT
// The host's clock: whole cycles and an exact rest.
#include "emulator/host/host_clock.hpp"

#include <cmath>

namespace torolux {

namespace {
__extension__ using Wide = unsigned __int128;
}

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
  cycles_ += static_cast<Cycles>(sum / host_hertz_);
  part_ = static_cast<std::uint64_t>(sum % host_hertz_);
}

}  // namespace torolux
