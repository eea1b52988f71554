// SPDX-License-Identifier: MIT
// What a machine cannot do with PEs on other ranks, and what to do instead.
#include <string>

#include "emulator/engines/engine_names.hpp"
#include "emulator/errors.hpp"
#include "emulator/remote/remote_pes.hpp"

namespace torolux::remote {
namespace {

void refuse(bool asked, const std::string& what, const std::string& instead) {
  if (asked) throw UsageError(what + " does not go with PEs on other ranks: " + instead);
}

}  // namespace

void check_goes_with_ranks(const MachineSetup& setup) {
  const std::string alone = "leave out --ranks, or mpirun";
  const Debugging& debugging = setup.debugging;
  refuse(setup.engine == kQemuEngine || !debugging.qemu_pes.empty(), "the engine qemu",
         "take the engine translated, interpreted or auto, or " + alone);
  refuse(!debugging.gdb.empty() || debugging.own || debugging.debugger != nullptr, "a debugger", alone);
  refuse(setup.profile != nullptr, "a profile of instructions", alone);
  refuse(setup.watcher != nullptr, "a trace of the PEs' states", alone);
}

}  // namespace torolux::remote
