// SPDX-License-Identifier: MIT
// A flag that signals set becomes an exception.
#include "host_tools/scene/keep_on.hpp"

#include "emulator/errors.hpp"
#include "host_tools/cli/command.hpp"

namespace torolux {

void look_for_interruption() {
  if (interrupted()) throw Interrupted("interrupted while the scene was loaded");
}

}  // namespace torolux
