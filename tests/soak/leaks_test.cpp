// SPDX-License-Identifier: MIT
// Twenty million rays in closed rooms at a hundred grids by chance, half of them aimed at edges and vertices: none
// escapes. A million at fixed grids is among the unit tests.
#include <gtest/gtest.h>

#include "tests/soak/random_machine.hpp"
#include "tests/unit/firmware/pe/closed_rooms.hpp"

namespace torolux::test {
namespace {

TEST(Leaks, NoRayEscapesAtAnyGrid) {
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    MachineDice dice(seed);
    const std::array<std::uint32_t, 3> grid{dice.number(1, 24), dice.number(1, 24), dice.number(1, 24)};
    const auto edge = [&dice] { return 0.05F + 0.95F * static_cast<float>(dice.number(0, 1000)) / 1000.0F; };
    protocol::Vec3f size{edge(), edge(), edge()};
    size[dice.number(0, 2)] = 1;
    Case tested = room(dice.number(1, 6), grid, size);
    tested.rays = 200'000;
    SCOPED_TRACE("seed " + std::to_string(seed) + ", grid " + std::to_string(grid[0]) + "x" + std::to_string(grid[1]) +
                 "x" + std::to_string(grid[2]));
    no_ray_escapes(tested, seed);
    if (testing::Test::HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace torolux::test
