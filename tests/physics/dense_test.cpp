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
  result.quality.shot_points = 24;
  result.quality.emission_records = 30'000'000;
  result.quality.unshot = 1e-5;
  return result;
}

// 62 elements inside; the bound for so few: 1 % everywhere. Seen: RMSE 0.10 %, the worst element 0.33 % off, by
// noise of form factors of 0.01 and less; 2 % with 8 x 8 points.
TEST(DenseSolution, OfAnEmptyRoomIsTheRadiosityStages) {
  const DenseErrors errors = dense_errors(solve_scene(room("lamp_room")), 0);
  EXPECT_EQ(errors.elements, 62U);
  EXPECT_LT(errors.rmse, 0.003);
  EXPECT_LT(errors.worst, 0.01);
}

// With the penumbras of a post, and elements as many as smaller ones near each other make of so few. The dense form
// factors' own 40 x 9 visibility rays have a part in what is seen: RMSE 0.08 %, worst 0.84 %.
TEST(DenseSolution, OfARoomWithAPostIsTheRadiosityStages) {
  RenderCase post = room("post_room");
  post.quality.patch_length = post.quality.element_length = 1;
  post.quality.shot_points = 32;
  const DenseErrors errors = dense_errors(solve_scene(post), 40);
  EXPECT_LT(errors.rmse, 0.003);
  EXPECT_LT(errors.worst, 0.01);
}

}  // namespace
}  // namespace torolux::test
