// SPDX-License-Identifier: MIT
// What an engine is besides, where its PEs could go on while they are saved: threads of this process, or other ranks
// run them.
#pragma once

#include "emulator/snapshot/archive.hpp"

namespace torolux {

/// For the scheduler's thread.
class PeHold {
 public:
  virtual ~PeHold() = default;
  /// From here to `let_go` no PE executes anything, even one that waits in a HINT and could go on; what all have said
  /// is in their channels. So Engine::save finds each as its channel says.
  virtual void hold() = 0;
  virtual void let_go() = 0;
  /// Of a PE of another rank, held: writes its channel as archive_channel does (niu/channel_archive.hpp). False: its
  /// channel is in this process.
  virtual bool save_channel(unsigned /*pe*/, SnapshotWriter& /*archive*/) { return false; }
};

}  // namespace torolux
