// SPDX-License-Identifier: MIT
// The radiosity stage against the radiosity equation solved as one system, on small rooms with the same elements.
#include <gtest/gtest.h>

#include "tests/support/dense_errors.hpp"

namespace torolux::test {
namespace {

RenderCase room(const char* name) {
  RenderCase result = native_case(data_dir() / "scenes" / name);
  result.machine.subspaces = {2, 2, 2};
  result.quality.patch_length = result.quality.element_length = 0.75;
  result.quality.hemicube = 16;
  result.quality.shot_points = 8;
  result.quality.unshot = 1e-5;
  return result;
}

// 58 elements inside. Seen: RMSE 0.46 %, the worst element 2.0 % off, by noise of form factors of 0.01 and less; half
// as much with twice as many points.
TEST(DenseSolution, OfAnEmptyRoomIsTheRadiosityStages) {
  const DenseErrors errors = dense_errors(solve_scene(room("lamp_room")), 0);
  EXPECT_EQ(errors.elements, 58U);
  EXPECT_LT(errors.rmse, 0.01);
  EXPECT_LT(errors.worst, 0.04);
}

// With the penumbras of a post. Seen: RMSE 0.46 %, worst 2.4 %.
TEST(DenseSolution, OfARoomWithAPostIsTheRadiosityStages) {
  const DenseErrors errors = dense_errors(solve_scene(room("post_room")), 16);
  EXPECT_LT(errors.rmse, 0.01);
  EXPECT_LT(errors.worst, 0.04);
}

}  // namespace
}  // namespace torolux::test
