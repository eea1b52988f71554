// SPDX-License-Identifier: MIT
// How many points a shot has: the owner makes them, and the host, which deals them, counts them.
#pragma once

#include <algorithm>
#include <cstdint>

#include "firmware/protocol/messages.hpp"

namespace torolux::protocol {

/// k * k points. Little light leaves from few points, so that no record carries much less than others: what it would
/// add to the picture is not worth its way. points_per_quantum: of reflected light, by the greatest channel of `flux`.
inline std::uint32_t points_of_shot(ShotKind kind, const Flux& flux, float points_per_quantum,
                                    std::uint32_t shot_points, std::uint32_t emission_points) {
  if (kind == ShotKind::emitted) return emission_points * emission_points;
  const std::int64_t most = std::max({flux[0], flux[1], flux[2]});
  const float points = static_cast<float>(most) * points_per_quantum;
  std::uint32_t grid = 1;
  while (grid < shot_points && static_cast<float>(grid * grid) < points) ++grid;
  return grid * grid;
}

}  // namespace torolux::protocol
