// SPDX-License-Identifier: MIT
// Each run has a machine of its own.
#include "host_tools/run/debugged_run.hpp"

namespace torolux {

MachineFigures run_debugged(debugger::Session* session, const std::function<MachineFigures(SnapshotReader*)>& run) {
  if (session == nullptr) return run(nullptr);
  return run_with_debugger(session, [&] {
    for (;;) {
      try {
        return run(session->from());
      } catch (const debugger::GoesBack&) {
        continue;
      }
    }
  });
}

}  // namespace torolux
