// SPDX-License-Identifier: MIT
// What the two ways to conduct the ray tracing stage have in common: the host makes the rays, or PEs make them of
// tiles.
#pragma once

#include <cstdint>

#include "host_tools/layout/golden_step.hpp"
#include "host_tools/stages/phase.hpp"

namespace torolux {

struct RayTracingSettings {
  std::uint64_t credits = 256;  ///< W, > 0
  std::uint32_t width = 1, height = 1, samples = 1;
  bool skip_empty_subspaces = true;  ///< where the host makes the rays
};

class RayPhase : public Phase {
 public:
  virtual std::uint64_t made() const = 0;   ///< rays considered so far
  virtual std::uint64_t count() const = 0;  ///< in all
  virtual std::uint64_t sent() const = 0;   ///< that met the object space
  virtual std::uint64_t credits_home() const = 0;
};

}  // namespace torolux
