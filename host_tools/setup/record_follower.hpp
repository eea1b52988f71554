// SPDX-License-Identifier: MIT
// Who follows a record through a render: what a record watcher is told, and before it what the run is of.
#pragma once

#include "emulator/trace/record_watcher.hpp"
#include "host_tools/setup/setup.hpp"

namespace torolux {

class RecordFollower : public RecordWatcher {
 public:
  /// Before the machine that makes the picture starts; all outlive its run. Throws InputError where there is nothing of
  /// what is to be followed.
  virtual void begin(const Scene& scene, const RenderSetup& setup, const Quality& quality,
                     const MachineChoice& machine) = 0;
};

}  // namespace torolux
