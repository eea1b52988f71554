// SPDX-License-Identifier: MIT
// How far a render is.
#pragma once

#include <cstdint>

#include "emulator/machine/machine.hpp"

namespace torolux {

struct RunningRender;  // host_tools/render/running_render.hpp

enum class RenderStage { load, radiosity, ray_tracing };

struct RenderProgress {
  RenderStage stage;
  double fraction;         ///< of the stage, estimated, 0..1
  double unshot_fraction;  ///< of the emitted flux
  std::uint64_t credits_home, credits_total;
  Cycles virtual_time;
  double overall = 0;                      ///< of all stages together, drafts' included, 0..1; rough
  const RunningRender* running = nullptr;  ///< for whoever looks closer; valid during the call
  double radiosity_records = 0;            ///< as long as which the radiosity stage takes, roughly; 0: not known
};

}  // namespace torolux
