// SPDX-License-Identifier: MIT
// Figures by PE in, their sums out.
#pragma once

#include <array>
#include <vector>

#include "emulator/machine/machine.hpp"

namespace torolux {

struct PeSums {
  Cycles busy = 0, outside = 0, idle_at_end = 0;
  WaitCycles waits{};
  std::uint64_t sent = 0, delivered = 0, diverted = 0;
  std::array<Cycles, protocol::kPhases> phases{};
};

inline PeSums sums_of(const std::vector<PeFigures>& pes) {
  PeSums sums;
  for (const PeFigures& pe : pes) {
    sums.busy += pe.busy_cycles;
    sums.outside += pe.outside_phases();
    sums.idle_at_end += pe.idle_at_end;
    for (std::size_t i = 0; i < kWaitReasons; ++i) sums.waits[i] += pe.waits[i];
    sums.sent += pe.packets_sent;
    sums.delivered += pe.packets_delivered;
    sums.diverted += pe.records_diverted;
    for (std::size_t i = 0; i < sums.phases.size(); ++i) sums.phases[i] += pe.phase_cycles[i];
  }
  return sums;
}

}  // namespace torolux
