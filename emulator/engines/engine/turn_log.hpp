// SPDX-License-Identifier: MIT
// Which PE ran when, in a run of one thread: enough to tell how long the same run takes with more.
#pragma once

#include <cstdint>
#include <vector>

namespace torolux {

/// From when a PE goes on until it waits, or has run for some milliseconds. Times are the scheduler's own: those in
/// which it runs a PE are left out.
struct Turn {
  double ready;    ///< from here on it could have run [s]
  double asked;    ///< here the scheduler could not go on without it [s]
  double seconds;  ///< how long it ran
  std::uint32_t pe = 0;
};

struct TurnLog {
  std::vector<Turn> turns;  ///< in the order in which they were asked for
  double own_seconds = 0;   ///< the scheduler's own time, from the PEs' start to their end
};

}  // namespace torolux
