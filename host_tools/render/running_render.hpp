// SPDX-License-Identifier: MIT
// A render's machine while it runs, for whoever looks at it from within `progress`; nothing may be changed.
#pragma once

#include "emulator/machine/machine.hpp"
#include "host_tools/setup/setup.hpp"
#include "host_tools/stages/render_program.hpp"

namespace torolux {

struct RunningRender {
  const Machine& machine;  ///< another one for each draft, and for the picture
  const RenderProgram& program;
  const RenderSetup& setup;
  bool draft;       ///< it solves a draft: no picture comes of it
  unsigned number;  ///< of the machine among those of the render, from 1
};

}  // namespace torolux
