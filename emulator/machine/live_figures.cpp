// SPDX-License-Identifier: MIT
// The channels' counters enter, as the PEs have last written them; figures leave.
#include "emulator/machine/live_figures.hpp"

#include "emulator/machine/emulation.hpp"

namespace torolux {

void Emulation::sample(LiveFigures& figures) const {
  constexpr auto relaxed = std::memory_order_relaxed;
  figures.now = now_;
  figures.torus_packets = torus_.packets_inside();
  figures.pixels_added = controller_.pixels_added();
  figures.pes.resize(pes_);
  for (unsigned pe = 0; pe < pes_; ++pe) {
    const NiuChannel& channel = *channels_[pe];
    LivePe& out = figures.pes[pe];
    out.clock = channel.clock.load(relaxed);
    out.waited = 0;
    for (const auto& wait : channel.waits) out.waited += wait.load(relaxed);
    for (std::size_t i = 0; i < protocol::kPhases; ++i) out.phase_cycles[i] = channel.phase_cycles[i].load(relaxed);
    for (std::size_t i = 0; i < kLinks; ++i) out.link_flits[i] = torus_.link_flits(pe, i);
  }
}

}  // namespace torolux
