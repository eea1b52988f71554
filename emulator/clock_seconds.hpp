// SPDX-License-Identifier: MIT
// The computer's own clocks, for figures of what a run costs it; nothing of a run depends on them.
#pragma once

#include <ctime>

namespace torolux {

/// Of a clock of clock_gettime [s].
inline double clock_seconds(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace torolux
