// SPDX-License-Identifier: MIT
// Plans of studies and statistics to be repeated, cut and changed at random (a fixed seed): nothing crashes, and all
// that is not loaded is refused.
#include <gtest/gtest.h>

#include "tests/fuzz/load_study.hpp"
#include "tests/fuzz/smoke.hpp"

namespace torolux {
namespace {

TEST(FuzzSmoke, StudyPlan) {
  smoke("study_plan", 5'000, load_study_plan);
}
TEST(FuzzSmoke, Statistics) {
  smoke("statistics", 2'000, load_statistics);
}

}  // namespace
}  // namespace torolux
