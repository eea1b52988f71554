// SPDX-License-Identifier: MIT
// A machine while it runs, at a glance. Sums of what its parts have told so far leave; the difference of two glances is
// what has happened between them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "emulator/torus/shape.hpp"
#include "firmware/protocol/hints.hpp"

namespace torolux {

/// Of a PE: what it had told when it last ended a HINT. It may be ahead of the network's time, or behind.
struct LivePe {
  std::uint64_t clock = 0;                                      ///< [cycles]
  std::uint64_t waited = 0;                                     ///< of those
  std::array<std::uint64_t, protocol::kPhases> phase_cycles{};  ///< busy, by innermost phase, up to the last marker
  std::array<std::uint64_t, kLinks> link_flits{};               ///< sent over its outgoing links
  bool operator==(const LivePe&) const = default;
};

struct LiveFigures {
  std::uint64_t now = 0;  ///< virtual time of the network [cycles]
  std::size_t torus_packets = 0;
  std::uint64_t pixels_added = 0;
  std::vector<LivePe> pes;
  bool operator==(const LiveFigures&) const = default;
};

}  // namespace torolux
