// SPDX-License-Identifier: MIT
// Plans of studies and statistics to be repeated, cut and changed at random (a fixed seed): nothing crashes, and all
// that is not loaded is refused.
#include <gtest/gtest.h>

#include "tests/fuzz/load_study.hpp"
#include "tests/fuzz/mutator.hpp"

namespace torolux {
namespace {

template <class Load>
void smoke(const std::string& name, int count, Load load) {
  const std::vector<std::string> texts = corpus(name);
  ASSERT_FALSE(texts.empty());
  for (const std::string& text : texts) EXPECT_TRUE(load(text)) << "the corpus itself is good";
  Mutator mutator(texts);
  int loaded = 0;
  for (int i = 0; i < count; ++i) loaded += load(mutator.next()) ? 1 : 0;
  // Some must live and some must be refused, or the test would prove nothing.
  EXPECT_GT(loaded, count / 200);
  EXPECT_LT(loaded, count - count / 100);
}

TEST(FuzzSmoke, StudyPlan) {
  smoke("study_plan", 5'000, load_study_plan);
}
TEST(FuzzSmoke, Statistics) {
  smoke("statistics", 2'000, load_statistics);
}

}  // namespace
}  // namespace torolux
