// SPDX-License-Identifier: MIT
// What the two ways to conduct the ray tracing stage have in common: the host makes the rays, or PEs make them of
// tiles.
#pragma once

#include <cstdint>

#include "host_tools/layout/golden_step.hpp"
#include "host_tools/stages/phase.hpp"

namespace torolux {

/// Some of each pixel's samples: the i-th is (first + i) * step modulo their number (protocol::View).
struct SamplePass {
  std::uint32_t first = 0, count = 1, step = 1;
};

struct RayTracingSettings {
  std::uint64_t credits = 256;  ///< W, > 0
  std::uint32_t width = 1, height = 1, samples = 1;
  SamplePass pass;                   ///< those that are taken; each weighs 1 / samples, whatever the pass
  bool skip_empty_subspaces = true;  ///< where the host makes the rays
  std::uint32_t least_samples = 0;   ///< not 0: pixels have so many, and up to `samples` where they need them
  double noise = 0;                  ///< need: the halves of a block's samples differ by more [L*]
};

class RayPhase : public Phase {
 public:
  virtual std::uint64_t made() const = 0;   ///< rays considered so far
  virtual std::uint64_t count() const = 0;  ///< in all
  virtual std::uint64_t sent() const = 0;   ///< that met the object space
  virtual std::uint64_t credits_home() const = 0;
  /// No more rays are handed out: it is done when those on their way have ended.
  virtual void give_up() = 0;
};

}  // namespace torolux
