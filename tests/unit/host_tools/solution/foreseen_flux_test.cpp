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

// Without gathering a picture shows what is foreseen, with the noise of records.
TEST(PictureLight, IsWhatIsForeseenWhereNothingGathered) {
  Room room(kEmitted / 2);
  EXPECT_TRUE(picture_light(room.mesh, room.solution, true, false).of_record.empty()) << "no records were counted";
  room.solution.tally.rays = 1000;
  const PictureLight light = picture_light(room.mesh, room.solution, true, false);
  EXPECT_EQ(light.flux, foreseen_flux(room.mesh, room.solution, true));
  EXPECT_EQ(light.of_record, std::vector<double>(light.flux.size(), flux_of_record(room.solution)));
}

// With it, the mean of what points found, and what was kept apart; noise is that of rays and of records by what each
// brought. Nothing is unshot here, so that nothing is added for it.
TEST(PictureLight, IsWhatPointsFoundAndWhatIsKeptApart) {
  Room room(2 * kEmitted);
  Solution& solution = room.solution;
  solution.tally.rays = 1000;
  solution.tally.gather_rays = 400;
  SolvedElement& element = solution.elements[room.element];
  element.apart = grey(3000);
  element.gathered = grey(20'000);
  element.points = 5;
  const PictureLight light = picture_light(room.mesh, solution, true, false);
  EXPECT_EQ(light.flux[room.element], grey(3000 + 20'000 / 5));
  EXPECT_EQ(picture_light(room.mesh, solution, false, false).flux, light.flux) << "all of it is in both";
  element.apart = {};
  const double of_rays = picture_light(room.mesh, solution, true, false).of_record[room.element];
  EXPECT_LT(of_rays, 4000.0 / 400) << "rays look evenly around";
  element.apart = grey(4000);
  const double of_both = picture_light(room.mesh, solution, true, false).of_record[room.element];
  EXPECT_DOUBLE_EQ(of_both, (of_rays + flux_of_record(solution)) / 2);
  element.points = 0;
  EXPECT_EQ(picture_light(room.mesh, solution, true, false).flux[room.element], grey(4000)) << "who has not gathered";
}

/// Of an element whose one point found so much, where half of the light that was shot is to be shot again.
double shown_of(std::int64_t found, bool emission_found) {
  Room room(kEmitted);
  room.solution.tally.rays = room.solution.tally.gather_rays = 1000;
  SolvedElement& element = room.solution.elements[room.element];
  element.apart = {};
  element.points = 1;
  element.gathered = grey(found);
  return static_cast<double>(picture_light(room.mesh, room.solution, true, emission_found).flux[room.element][0]);
}

// What is still unshot would light what rays have met, by the part of light that comes by reflection. Of all that came
// so far: emission once, and half of what was shot.
TEST(PictureLight, ForeseesWhatIsUnshot) {
  EXPECT_NEAR(shown_of(kEmitted * 3 / 4, false), static_cast<double>(kEmitted), 10);
}

// Where rays found emission beside all that reflects what came, the rest comes beside both: emission once, half of one
// and a half of it, and in the end as much reflected as emitted.
TEST(PictureLight, ForeseesTheRestBesideEmissionThatRaysFound) {
  EXPECT_NEAR(shown_of(kEmitted + kEmitted * 3 / 4, true), 2.0 * kEmitted, 10);
}

}  // namespace
}  // namespace torolux
