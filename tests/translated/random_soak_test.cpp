// SPDX-License-Identifier: MIT
// A billion random instructions: registers, memory, cycles and counts are QEMU's.
#include <gtest/gtest.h>

#include <string>

#include "tests/translated/random_program.hpp"

namespace torolux::test {
namespace {

constexpr std::uint64_t kBatches = 20;
constexpr std::uint64_t kPrograms = 10;  // of a batch; every second one sees its flags
constexpr std::uint64_t kInstructionsEach = 5'000'000;
static_assert(kBatches * kPrograms * kInstructionsEach == 1'000'000'000);

class TranslatedSoak : public testing::TestWithParam<std::uint64_t> {};

TEST_P(TranslatedSoak, ProgramsRunAsOnQemu) {
  for (std::uint64_t n = 0; n < kPrograms; ++n) {
    const std::uint64_t seed = 1'000'000 + GetParam() * kPrograms + n;
    const RandomProgram program = make_random_program(seed, kInstructionsEach, n % 2 != 0);
    const Outcome outcome = run_on_all(program.image, "seed " + std::to_string(seed), program.fill);
    EXPECT_GT(outcome.instructions, kInstructionsEach / 2);
  }
}

INSTANTIATE_TEST_SUITE_P(Batches, TranslatedSoak, testing::Range<std::uint64_t>(0, kBatches));

}  // namespace
}  // namespace torolux::test
