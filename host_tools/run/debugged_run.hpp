// SPDX-License-Identifier: MIT
// A run in a debugger's hands: runs again and again from where the debugger goes back to, until one comes to its end,
// of which the debugger is told.
#pragma once

#include "emulator/debugger/session.hpp"
#include "emulator/errors.hpp"

namespace torolux {

/// What `run` gives; the debugger is told how it ended. session: null: nobody holds the PEs. Throws what `run` throws.
template <class Run>
auto run_with_debugger(debugger::Session* session, Run run) {
  try {
    auto result = run();
    if (session != nullptr) session->finish(static_cast<int>(ExitCode::done), "");
    return result;
  } catch (const MachineFailure& failure) {
    if (session != nullptr) session->finish(static_cast<int>(ExitCode::machine_failure), failure.what());
    throw;
  }
}

/// The same with a debugger that may go back. run: is given the state from which to go on (SnapshotReader*), null: from
/// the beginning; each time with a machine of its own.
template <class Run>
auto run_debugged(debugger::Session* session, Run run) {
  return run_with_debugger(session, [&] {
    for (;;) {
      try {
        return run(session != nullptr ? session->from() : nullptr);
      } catch (const debugger::GoesBack&) {
        continue;
      }
    }
  });
}

}  // namespace torolux
