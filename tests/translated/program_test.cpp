// SPDX-License-Identifier: MIT
// Whole images: what they send, leave in memory and take in cycles is the same on all ways of running them.
#include <gtest/gtest.h>

#include "tests/translated/runs.hpp"
#include "tests/unit/engines/engine_support.hpp"

namespace torolux::test {
namespace {

TEST(TranslatedProgram, HelloIsTheSame) {
  const Outcome outcome = run_on_all(load_image(example_image("hello")), "hello.elf");
  EXPECT_TRUE(outcome.halted);
  EXPECT_GT(outcome.instructions, 100U) << outcome.clock << " " << outcome.word(0x80000000 + 0) << outcome.failure;
}

}  // namespace
}  // namespace torolux::test
