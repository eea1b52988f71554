// SPDX-License-Identifier: MIT
// Who keeps what a running machine is: asked when it may stand still, given its state.
#pragma once

#include <functional>

#include "emulator/snapshot/archive.hpp"

namespace torolux {

/// Changes nothing of the run. Called from the thread that runs the machine.
class SnapshotKeeper {
 public:
  virtual ~SnapshotKeeper() = default;
  /// Asked whenever the host has read a message: whether the state is wanted now. Cheap.
  virtual bool is_due() = 0;
  /// It was, and the machine stands still. machine: writes all of it but the host's program; to be called once. May
  /// throw, which ends the run.
  virtual void keep(const std::function<void(SnapshotWriter&)>& machine) = 0;
};

}  // namespace torolux
