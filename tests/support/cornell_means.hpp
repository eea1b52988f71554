// SPDX-License-Identifier: MIT
// The Cornell box against an independent path tracer: its solution in, radiances of its surfaces out, and what they
// should be (tests/data/README.md).
#pragma once

#include <array>
#include <vector>

#include "tests/support/solve_scene.hpp"

namespace torolux::test {

/// Triangles 2 q and 2 q + 1 of the scene are quadrilateral q, in the order of the scene file. Radiance B / pi, mean
/// over each. [W/(m^2 sr)]
std::vector<std::array<double, 3>> mean_radiance(const SolvedScene& cornell);

/// The same, of the element at a point of a triangle; b1, b2: weights of its corners 1 and 2 [W/(m^2 sr)].
std::array<double, 3> radiance_at(const SolvedScene& cornell, std::uint32_t triangle, float b1, float b2);

/// Path traced means of B / pi, to 0.1 % (../shared/data/references.md). The floor's counts what the blocks hide as
/// dark.
struct CornellMean {
  const char* name;
  std::size_t quad;
  std::array<double, 3> radiance;
};
inline constexpr std::array<CornellMean, 7> kCornellMeans = {{
    {"floor", 0, {.11059, .07364, .01998}},
    {"ceiling", 2, {.09624, .05745, .01351}},
    {"back", 3, {.16748, .10995, .02969}},
    {"green wall", 4, {.03488, .07574, .00456}},
    {"red wall", 5, {.13950, .00930, .00214}},
    {"short block's top", 6, {.31499, .22070, .06489}},
    {"tall block's top", 11, {.72229, .47790, .14893}},
}};

}  // namespace torolux::test
