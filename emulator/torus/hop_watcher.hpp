// SPDX-License-Identifier: MIT
// Who follows packets from router to router: each hop enters when it begins, with the times at which it does and ends.
#pragma once

#include <cstddef>

#include "emulator/time/event_queue.hpp"
#include "emulator/torus/block.hpp"

namespace torolux {

/// Told of good copies alone. Changes nothing of the run.
class HopWatcher {
 public:
  virtual ~HopWatcher() = default;
  /// Stands in the outgoing queue of its PE.
  virtual void entered(unsigned pe, const Block& packet) = 0;
  /// Its head goes through an output from `start` on, and is at the next router, or the whole packet at its PE where
  /// the output is the local one, at `arrives`.
  virtual void leaves(unsigned router, std::size_t output, const Block& packet, Cycles start, Cycles arrives) = 0;
};

}  // namespace torolux
