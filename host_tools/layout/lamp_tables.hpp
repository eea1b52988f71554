// SPDX-License-Identifier: MIT
// A scene's measured lamps enter; the tables by which PEs draw their light and look it up leave.
#pragma once

#include <cstdint>
#include <vector>

#include "firmware/protocol/lamp.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

struct LampTables {
  std::vector<protocol::Lamp> lamps;  ///< by Scene::lamps; those of one web share its tables
  std::vector<float> values;
  std::vector<std::uint32_t> chances;
};
LampTables lamp_tables(const Scene& scene);

/// Of each lamp the greatest radiance that is seen of it, in units of its material's emission.
std::vector<double> brightest_seen(const Scene& scene);

}  // namespace torolux
