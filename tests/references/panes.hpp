// SPDX-License-Identifier: MIT
// Panes between two points: what of straight light they let through.
#pragma once

#include "tests/references/scattering.hpp"

namespace torolux::references {

/// Of the light between two points, but for the triangle that it leaves and the one that it is to reach; 0 where
/// anything else than panes lies between them.
Colour passed(const World& world, const Vec& from, const Vec& to, std::uint32_t leaving, std::uint32_t target);

}  // namespace torolux::references
