// SPDX-License-Identifier: MIT
// Light at the feet of things that stand on a floor whose elements do not follow them: none gets under them, and what
// is seen beside them is as the path tracer has it, with and without shadow rays.
#include <gtest/gtest.h>

#include "tests/references/picture_error.hpp"
#include "tests/support/solve_scene.hpp"

namespace torolux::test {
namespace {

RenderCase blocks(bool shadow_rays) {
  RenderCase result = native_case(source_dir() / "scenes" / "colour_bleeding");
  Quality& quality = result.quality;
  quality.width = 64;
  quality.height = 32;
  quality.samples = 16;
  quality.shot_points = 4;
  quality.emission_records = 1'000'000;
  quality.unshot = 0.01;
  quality.shadow_rays = shadow_rays;
  result.machine.columns = result.machine.rows = 1;
  // The long foot of the low block, and the floor before it.
  result.camera = Camera{{2.0, 1.4, 4.3}, {2.08, 0.02, 2.36}, {0, 1, 0}, 5};
  return result;
}

TEST(Feet, NoLightGetsUnderABlock) {
  RenderCase rough = blocks(true);
  rough.quality.emission_records = 100'000;
  rough.quality.shot_points = 2;
  rough.quality.unshot = 0.001;  // the block's inside would be among the last to shoot
  const SolvedScene solved = solve_scene(rough);
  const Mesh& mesh = solved.mesh;
  int under = 0;
  double lost = 0;
  double all = 0;
  for (const MeshPatch& patch : mesh.patches) {
    if (patch.is_clustered() || patch.side[0] == protocol::kNoSide) continue;
    for (std::uint32_t e = 0; e < patch.elements; ++e) {
      const MeshFacet& facet = mesh.facets[patch.first_facet + e];
      const double flux = solved.incident_flux(patch.first_element[0] + e)[1];
      all += flux;
      if (mesh.walls.touch(facet.triangle, facet.code) ||
          !mesh.hiding.hides(mesh, facet.triangle, 0, middle_of_grid(facet.code))) {
        continue;
      }
      ++under;
      lost += flux;
    }
  }
  EXPECT_GT(under, 20);
  // Seen: 1.3e-6, from parts of elements that are too narrow to be told; 47e-6 where elements shoot from all their
  // area.
  EXPECT_LT(lost, 5e-6 * all);
}

TEST(Feet, FloorBesideABlockIsAsBrightAsInThePathTracer) {
  const RenderCase with_rays = blocks(true);
  const Scene scene = load_scene(with_rays.scene, {});
  references::TraceChoice choice;
  choice.width = with_rays.quality.width;
  choice.height = with_rays.quality.height;
  choice.samples = 256;
  const references::TracedPicture traced =
      references::trace(references::World(scene, false), *with_rays.camera, choice);
  EXPECT_LT(references::reference_noise(traced), 0.01);
  // Seen: mean +3.6 % and +7.3 %, RMSE 9.8 % and 18 %: it is the deepest of the shadow that is looked at, two elements
  // wide. With light under the block, means are +5.8 % and +9.4 %.
  const auto sharp = references::picture_error(run_case(blocks(true)).picture, traced.picture);
  EXPECT_NEAR(sharp.plain_mean, 0, 0.047);
  EXPECT_LT(sharp.rmse, 0.12);
  const auto soft = references::picture_error(run_case(blocks(false)).picture, traced.picture);
  EXPECT_NEAR(soft.plain_mean, 0, 0.084);
  EXPECT_LT(soft.rmse, 0.21);
}

}  // namespace
}  // namespace torolux::test
