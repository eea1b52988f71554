// SPDX-License-Identifier: MIT
// A fuzzer's corpus, cut and changed by a fixed seed, in every build. Enters: what takes an input, true: it is
// accepted.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/fuzz/mutator.hpp"

namespace torolux {

template <class Take>
void smoke(const std::string& name, int count, Take take) {
  const std::vector<std::string> inputs = corpus(name);
  ASSERT_FALSE(inputs.empty());
  for (const std::string& input : inputs) EXPECT_TRUE(take(input)) << "the corpus itself is good";
  Mutator mutator(inputs);
  int taken = 0;
  for (int i = 0; i < count; ++i) taken += take(mutator.next()) ? 1 : 0;
  // Some must live and some must be refused, or the test would prove nothing.
  EXPECT_GT(taken, count / 200);
  EXPECT_LT(taken, count - count / 100);
}

}  // namespace torolux
