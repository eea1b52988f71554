// SPDX-License-Identifier: MIT
// Proves that the estimate of what is still unshot is right where its series is: in a closed room whose surfaces all
// reflect alike.
#include "host_tools/solution/foreseen_flux.hpp"

#include <gtest/gtest.h>

#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux {
namespace {

constexpr std::int64_t kEmitted = 1'000'000'000;  // quanta

protocol::Flux grey(std::int64_t flux) {
  return {flux, flux, flux};
}

/// A solution in which all light that was shot has come to one patch, which reflects half of it; of what came,
/// `shot` has been shot again.
struct Room {
  Mesh mesh;
  Solution solution;
  std::size_t element = 0;

  explicit Room(std::int64_t shot) {
    test::SceneBuilder builder;
    builder.quad(builder.material({0.5, 0.5, 0.5}), {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    builder.triangle(builder.material({0, 0, 0}, {1, 1, 1}), {0, 0, 1}, {0, 1, 1}, {1, 1, 1});
    mesh = make_mesh(builder.scene, {.patch_length = 2, .element_length = 2});
    solution.elements.resize(mesh.elements);
    solution.sides.resize(mesh.patch_sides);
    const MeshPatch& patch = mesh.patches.front();
    element = patch.first_element[0];
    const std::int64_t came = kEmitted + shot / 2;
    solution.emitted_shot = grey(kEmitted);
    solution.reflected_shot = grey(shot / 2);
    solution.elements[element] = {grey(came), grey(kEmitted)};
    solution.sides[patch.side[0]] = {grey(came), grey(shot), {}};
  }
  std::int64_t foreseen(bool without_direct) const { return foreseen_flux(mesh, solution, without_direct)[element][0]; }
};

TEST(ForeseenFlux, IsAllThatWouldCome) {
  // Half of what comes comes again: in all, as much as was emitted.
  for (const std::int64_t shot : {kEmitted / 100, kEmitted / 2, kEmitted * 19 / 10}) {
    const Room room(shot);
    EXPECT_NEAR(static_cast<double>(room.foreseen(true)), static_cast<double>(kEmitted), 10) << shot;
    EXPECT_NEAR(static_cast<double>(room.foreseen(false)), 2.0 * kEmitted, 10) << shot;
  }
}

TEST(ForeseenFlux, IsWhatCameWhereAllIsShotOrNothingWas) {
  const Room all(2 * kEmitted);
  EXPECT_EQ(all.foreseen(false), 2 * kEmitted);
  // Where reflected light goes is not known before any has been shot.
  const Room none(0);
  EXPECT_EQ(none.foreseen(false), kEmitted);
}

}  // namespace
}  // namespace torolux
