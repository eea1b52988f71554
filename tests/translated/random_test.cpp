// SPDX-License-Identifier: MIT
// Random instructions, ten million of them in all: registers, memory, cycles and counts are QEMU's.
#include <gtest/gtest.h>

#include <string>

#include "tests/translated/random_program.hpp"

namespace torolux::test {
namespace {

constexpr std::uint64_t kPrograms = 8;
constexpr std::uint64_t kInstructionsEach = 1'250'000;

void check_programs(std::uint64_t first_seed, bool sees_flags) {
  for (std::uint64_t seed = first_seed; seed < first_seed + kPrograms / 2; ++seed) {
    const RandomProgram program = make_random_program(seed, kInstructionsEach, sees_flags);
    const Outcome outcome = run_on_all(program.image, "seed " + std::to_string(seed), program.fill);
    EXPECT_GT(outcome.instructions, kInstructionsEach / 2);
  }
}

TEST(TranslatedRandom, ProgramsThatSeeNoFlags) {
  check_programs(1000, false);
}
TEST(TranslatedRandom, ProgramsThatSeeFlags) {
  check_programs(2000, true);
}

}  // namespace
}  // namespace torolux::test
