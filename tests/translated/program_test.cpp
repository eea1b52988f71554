// SPDX-License-Identifier: MIT
// Whole images: what they send, leave in memory and take in cycles is the same on all ways of running them.
#include <gtest/gtest.h>

#include "emulator/engines/translated/generate/generator.hpp"
#include "tests/translated/runs.hpp"
#include "tests/unit/emulator/engines/engine_support.hpp"

namespace torolux::test {
namespace {

TEST(TranslatedProgram, HelloIsTheSame) {
  const Outcome outcome = run_on_all(load_image(example_image("hello")), "hello.elf");
  EXPECT_TRUE(outcome.halted);
  EXPECT_GT(outcome.instructions, 100U) << outcome.clock << " " << outcome.word(0x80000000 + 0) << outcome.failure;
}

constexpr Reg kLog = 20, kT0 = 5;

/// The work of the host's compiler grows faster than a function does, so none may be long: here, of 20,000.
TEST(TranslatedProgram, StraightCodeIsDivided) {
  Code code;
  for (int n = 0; n < 20'000; ++n) code << addi(kT0, kT0, 1);
  code << hint(protocol::Hint::halt);
  const Image image = image_of(code);
  const translated::CodeMap map(image, MachineDescription{}.processor.latency);
  translated::Blocks blocks(image, map);
  constexpr std::uint32_t kMostBytes = 4 * 4096;
  for (const translated::GuestFunction& function : translated::make_functions(map, blocks)) {
    EXPECT_LE(function.bytes, kMostBytes + 4);
  }
}

TEST(TranslatedProgram, DividedCodeRunsOn) {
  Code code;
  code.li(kLog, kData);
  for (int n = 0; n < 4500; ++n) code << addi(kT0, kT0, 1);
  code << sw(kT0, kLog, 0) << hint(protocol::Hint::halt);
  EXPECT_EQ(run_on_all(image_of(code), "divided").word(kData), 0x8000'0000U + 4500);  // from the boot ROM's t0
}

/// A NaN from memory keeps its bits; one that was computed is RISC-V's. Here one register may hold either.
TEST(TranslatedProgram, ANanFromMemoryKeepsItsBitsWhereWaysMeet) {
  constexpr Word kNan = 0xFFC1'2345U;
  Code code;
  code.li(kT0, 0x2000) << csrrs(0, csr::kMstatus, kT0);  // floating point on
  code.li(kLog, kData).li(kT0, kNan) << sw(kT0, kLog, 0);
  for (Word computed = 0; computed < 2; ++computed) {
    code << flw(1, kLog, 0) << flw(2, kLog, 0) << addi(kT0, 0, static_cast<std::int32_t>(1 - computed));
    code << bne(kT0, 0, 8) << 0x0021'70D3U;                                             // fadd.s f1, f2, f2
    code << 0x2010'81D3U << fsw(3, kLog, static_cast<std::int32_t>(4 + 8 * computed));  // fsgnj.s f3, f1, f1
    code << fsw(1, kLog, static_cast<std::int32_t>(8 + 8 * computed));
  }
  code << hint(protocol::Hint::halt);
  const Outcome outcome = run_on_all(image_of(code), "NaN");
  ASSERT_TRUE(outcome.halted);
  for (const Word offset : {4U, 8U}) EXPECT_EQ(outcome.word(kData + offset), kNan);
  for (const Word offset : {12U, 16U}) EXPECT_EQ(outcome.word(kData + offset), 0x7FC0'0000U);
}

}  // namespace
}  // namespace torolux::test
