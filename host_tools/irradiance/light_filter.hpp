// SPDX-License-Identifier: MIT
// A filter for the noise of elements. Enter: what they received, and what a record carries; leaves: irradiance at the
// vertices that explains it with no more bends than noise leaves doubtful.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "firmware/protocol/stores.hpp"
#include "host_tools/irradiance/filter_plan.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

/// Light over a flat triangle is linear between its corners. Of all values at the free vertices those are looked for
/// that miss least of the elements' flux, bent as little as may be where they meet: a smoothing spline (Reinsch 1967)
/// whose penalty grows with a bend's square while noise alone could make it, and with the bend itself from there on
/// (Huber 1964; Kim, Koh, Boyd & Gorinevsky 2009, "l1 trend filtering"). So a gradient stays as it is, and an edge of
/// light does. No value moves by more than twice its standard deviation, so that what is narrow and bright stays, too;
/// but down to the darkest element around it: what means around vertices have spread over a rim of light leaves the
/// dark side, and goes to the bright one, where no value rises beyond the brightest element around it.
/// Where no vertex is kept, the best values hold exactly what the elements received; steps end when no more
/// is seen of the rest (docs/decisions/elements.md).
/// flux: by global element [quanta]. flux_of_record: likewise, what a record brings in the mean, of the channels.
/// values: by vertex, irradiance [quanta / user unit^2]: as well as is known without; changed.
void filter_light(const FilterPlan& plan, std::span<const protocol::Flux> flux, std::span<const double> flux_of_record,
                  std::vector<Vec3d>& values);

/// So often filter_light comes by each triangle.
inline constexpr std::uint64_t kFilterPasses = 32;

}  // namespace torolux
