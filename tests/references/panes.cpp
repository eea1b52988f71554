// SPDX-License-Identifier: MIT
// From pane to pane.
#include "tests/references/panes.hpp"

namespace torolux::references {

Colour passed(const World& world, const Vec& from, const Vec& to, std::uint32_t leaving, std::uint32_t target) {
  if (!world.has_panes()) return world.blocked(from, to, leaving, target) ? Colour::Zero() : Colour::Ones();
  const Vec direction = (to - from).normalized();
  const double there = (to - from).norm() * (1 - 1e-5);
  Colour light = Colour::Ones();
  for (Vec origin = from;;) {
    const auto hit = world.closest(origin, direction, leaving);
    if (!hit || hit->triangle == target || (hit->point - from).norm() >= there) return light;
    const Material& material = world.material(*hit);
    if (material.model != Model::pane) return Colour::Zero();
    light *= pane(direction, world.triangles()[hit->triangle].normal, material).passed;
    origin = world.leave(*hit, direction);
    leaving = hit->triangle;
  }
}

}  // namespace torolux::references
