// SPDX-License-Identifier: MIT
// How long a run takes with more cores, worked out from the turns that its PEs had on one thread.
#pragma once

#include "emulator/engines/engine/turn_log.hpp"

namespace torolux {

/// Wall time [s] of the same turns with so many threads, each on a core of its own, `cores` >= 1. List scheduling as
/// the translated engine does it: the scheduler's thread handles events in their order; a PE that may go on is taken by
/// the first thread that is free, the one that has been ready for longest first; where the scheduler cannot go on
/// without a PE, it runs that one, or others while another thread does. Caches, memory and clock rates are taken to be
/// those of one thread, and messages between threads to cost nothing: no computer takes less.
double predicted_seconds(const TurnLog& log, unsigned cores);

/// The same with so many ranks of one thread, `ranks` >= 2: rank 0 handles events, each of the others runs its own
/// block of PEs, and a message takes `exchange` [s], whatever is in it and however many are under way.
double predicted_on_ranks(const TurnLog& log, unsigned ranks, double exchange);

/// On one thread: what was measured.
double measured_seconds(const TurnLog& log);

}  // namespace torolux
