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
  quality.hemicube = 6;
  quality.shot_points = 8;
  quality.unshot = 0.01;
  quality.shadow_rays = shadow_rays;
  result.machine.columns = result.machine.rows = 1;
  // The long foot of the low block, and the floor before it.
  result.camera = Camera{{2.0, 1.4, 4.3}, {2.08, 0.02, 2.36}, {0, 1, 0}, 5};
  return result;
}

/// Of all light, what lies on floor that a thing hides.
double hidden_share(const SolvedScene& solved) {
  const Mesh& mesh = solved.mesh;
  int under = 0;
  double lost = 0;
  double all = 0;
  for (const MeshPatch& patch : mesh.patches) {
    if (patch.is_clustered() || patch.side[0] == protocol::kNoSide) continue;
    for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
      const MeshFacet& facet = mesh.facets[f];
      const double flux = facet.of_element * solved.incident_flux(patch.first_element[0] + facet.element)[1];
      all += flux;
      // The light of a hidden part's element came to those of its pieces that reach out beside the foot.
      if (facet.is_piece || !is_hidden(mesh, facet.triangle, facet.code)) continue;
      ++under;
      lost += flux;
    }
  }
  EXPECT_GT(under, 20);
  return lost / all;
}

TEST(Feet, NoLightGetsUnderABlock) {
  RenderCase rough = blocks(true);
  rough.quality.emission_records = 100'000;
  rough.quality.shot_points = 2;
  rough.quality.unshot = 0.001;  // the block's inside would be among the last to shoot
  double share = 0;
  for (const std::uint64_t seed : {std::uint64_t{1}, std::uint64_t{2}, std::uint64_t{3}}) {
    rough.quality.seed = seed;
    share += hidden_share(solve_scene(rough)) / 3;
  }
  // Seen: 8e-6, all of it with the first seed, where a few records meet parts of elements that are too narrow to be
  // told; nothing with seeds 2 to 6. 47e-6 where elements shoot from all their area.
  EXPECT_LT(share, 15e-6);
}

struct Errors {
  double mean = 0, rmse = 0;  ///< relative; of four seeds
};

Errors mean_errors(bool shadow_rays, const Picture& traced) {
  Errors errors;
  RenderCase render = blocks(shadow_rays);
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    render.quality.seed = seed;
    const auto error = references::picture_error(run_case(render).picture, traced);
    errors.mean += error.plain_mean / 4;
    errors.rmse += error.rmse / 4;
  }
  return errors;
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
  // It is the deepest of the shadow that is looked at, two elements wide: the mean differs by some 5 % from seed to
  // seed. Seen, of four seeds: -0.7 % and +1.2 %, RMSE 5.9 % and 15 %.
  const Errors sharp = mean_errors(true, traced.picture);
  EXPECT_NEAR(sharp.mean, 0, 0.047);
  EXPECT_LT(sharp.rmse, 0.12);
  const Errors soft = mean_errors(false, traced.picture);
  EXPECT_NEAR(soft.mean, 0, 0.084);
  EXPECT_LT(soft.rmse, 0.21);
}

}  // namespace
}  // namespace torolux::test
