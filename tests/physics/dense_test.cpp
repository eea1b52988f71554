// SPDX-License-Identifier: MIT
// The radiosity stage against the radiosity equation solved as one system, on small rooms with the same elements.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/references/dense_radiosity.hpp"
#include "tests/support/solve_scene.hpp"

namespace torolux::test {
namespace {

struct ElementErrors {
  double rmse, worst;  ///< of irradiance, relative: to the root mean square, to the element's own
};

ElementErrors element_errors(const SolvedScene& solved, unsigned visibility_rays) {
  const auto elements = references::dense_elements(solved.scene, solved.mesh, false);
  const auto factors =
      references::dense_form_factors(elements, references::World(solved.scene, false), {3, visibility_rays});
  const auto should = references::dense_irradiances(factors, references::dense_radiosities(elements, factors));
  double difference = 0;
  double square = 0;
  double worst = 0;
  for (std::uint32_t e = 0; e < elements.size(); ++e) {
    const auto flux = solved.incident_flux(e);
    for (std::size_t c = 0; c < 3; ++c) {
      const double is = flux[c] / elements[e].area;
      const double expected = should[e][static_cast<Eigen::Index>(c)];
      difference += elements[e].area * (is - expected) * (is - expected);
      square += elements[e].area * expected * expected;
      if (expected > 0) worst = std::fmax(worst, std::fabs(is / expected - 1));
    }
  }
  return {std::sqrt(difference / square), worst};
}

RenderCase room(const char* name) {
  RenderCase result = native_case(data_dir() / "scenes" / name);
  result.machine.subspaces = {2, 2, 2};
  result.quality.patch_length = result.quality.element_length = 0.75;
  result.quality.hemicube = 16;
  result.quality.shot_points = 4;
  result.quality.unshot = 1e-5;
  return result;
}

TEST(DenseSolution, OfAnEmptyRoomIsTheRadiosityStages) {
  const ElementErrors errors = element_errors(solve_scene(room("lamp_room")), 0);
  std::printf("empty room: RMSE %.2f %%, worst %.2f %%\n", 100 * errors.rmse, 100 * errors.worst);
  EXPECT_LT(errors.rmse, 0.01);
  EXPECT_LT(errors.worst, 0.04);
}

TEST(DenseSolution, OfARoomWithAPostIsTheRadiosityStages) {
  const ElementErrors errors = element_errors(solve_scene(room("post_room")), 16);
  std::printf("room with a post: RMSE %.2f %%, worst %.2f %%\n", 100 * errors.rmse, 100 * errors.worst);
  EXPECT_LT(errors.rmse, 0.01);
  EXPECT_LT(errors.worst, 0.04);
}

}  // namespace
}  // namespace torolux::test
