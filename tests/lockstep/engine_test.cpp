// SPDX-License-Identifier: MIT
// Proves: in lock step one wrong result, cost, marker, HINT or way of the translated engine is found at the HINT behind
// it, and the report says where; and engines that agree are said to agree.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "emulator/engines/lockstep/lockstep_engine.hpp"
#include "emulator/errors.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/translated/runs.hpp"
#include "tests/unit/emulator/engines/engine_support.hpp"

namespace torolux::test {
namespace {

using protocol::Hint;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing_support::message_of;

constexpr Reg kA0 = 10, kA1 = 11, kA2 = 12, kA3 = 13, kS0 = 8;
constexpr Word kMul = r_type(0x33, 0, 1, kA2, kA2, kA2);

Word marker(Hint base) {
  return protocol::hint_instruction(static_cast<std::int32_t>(base) + 3);
}

/// Words of the program, one of which a test may exchange.
std::vector<Word> program() {
  return {lui(kS0, kData),           addi(kA0, 0, 5),
          addi(kA1, kA0, 7),         sw(kA1, kS0, 0),
          hint(Hint::clock),  // HINT 1
          addi(kA2, kA1, 1),         kMul,
          marker(Hint::enter_phase), sw(kA2, kS0, 4),
          marker(Hint::leave_phase),
          hint(Hint::clock),  // HINT 2
          addi(kA3, kA2, 100),       addi(kA0, kA0, 1),
          sw(kA3, kS0, 8),           addi(kA0, kA0, 1),
          hint(Hint::clock),  // HINT 3
          hint(Hint::halt)};  // HINT 4
}

Image image_of_words(const std::vector<Word>& words) {
  Code code;
  for (const Word word : words) code << word;
  return image_of(code);
}

/// Runs a program until it halts, fails or the engines part.
void run(const lockstep::Options& options, const std::vector<Word>& words = program()) {
  BarePes pes(image_of_words(words), 1, {},
              [&](const EngineSetup& setup) { return lockstep::make_engine(setup, options); });
  const auto stop = [&] {
    pes.channel(0).stopping.store(1);
    pes.engine().stop();
  };
  try {
    pes.engine().start();
    bool halted = false;
    while (!halted) {
      const auto command = pes.next_command(0);
      if (!command) throw std::runtime_error("the PE does not halt");
      halted = command->head.kind == CommandKind::halt || command->head.kind == CommandKind::fail;
    }
  } catch (...) {
    stop();
    throw;
  }
  stop();
}

/// What is reported where the translated engine has another instruction at this place of the program.
std::string report_with(std::size_t index, Word instruction) {
  std::vector<Word> words = program();
  words[index] = instruction;
  const Image other = image_of_words(words);
  lockstep::Options options;
  options.other_image = &other;
  return message_of<MachineFailure>([&] { run(options); });
}

std::string report_with(InstructionClass instruction_class, std::uint32_t cycles) {
  LatencyTable latency = MachineDescription{}.processor.latency;
  latency[static_cast<std::size_t>(instruction_class)] = cycles;
  lockstep::Options options;
  options.other_latency = &latency;
  return message_of<MachineFailure>([&] { run(options); });
}

TEST(Lockstep, EnginesThatAgreeAreComparedToTheEnd) {
  lockstep::Totals totals;
  lockstep::Options options;
  options.ended = [&](const lockstep::Totals& all) { totals = all; };
  run(options);
  EXPECT_EQ(totals.hints, 4U);
  EXPECT_EQ(totals.markers, 2U);
  EXPECT_EQ(totals.instructions, 15U) << "markers are no instructions";
  EXPECT_GE(totals.bytes, 4U * 3U * 4096U) << "code, NIU window and data, at each HINT";
}

TEST(Lockstep, ATrapInTheMiddleOfABlockIsNoDifference) {
  constexpr Reg kT0 = 5;
  constexpr Word kHandler = 0x8000'0000U + 7 * 4;
  lockstep::Totals totals;
  lockstep::Options options;
  options.ended = [&](const lockstep::Totals& all) { totals = all; };
  run(options, {lui(kT0, kHandler), addi(kT0, kT0, kHandler & 0xFFFU), csrrw(0, csr::kMtvec, kT0),
                lw(kA0, 0, 0),  // nothing is there
                addi(kA0, kA0, 1), addi(kA0, kA0, 1), hint(Hint::halt),
                // The handler. QEMU has counted the rest of the block above, the translated engine has not.
                lui(kS0, kData), sw(kA0, kS0, 0), hint(Hint::fail)});
  EXPECT_EQ(totals.hints, 1U);
}

TEST(Lockstep, AWrongResultIsFoundWhereItLiesInMemory) {
  const std::string report = report_with(11, addi(kA3, kA2, 101));
  EXPECT_THAT(report, HasSubstr("PE 0: QEMU and the translated engine part at its HINT 3: local memory differs"));
  EXPECT_THAT(report, ContainsRegex("HINT +clock +clock +clock"));
  // (5 + 7 + 1)^2 + 100, and one more.
  EXPECT_THAT(report, ContainsRegex("word +0x0000010d +0x0000010e +0x0000010d"));
  EXPECT_THAT(report, HasSubstr("That word, at 0x80021008"));
  EXPECT_THAT(report, ContainsRegex("Last stored there, as interpreted, at pc .*, clock [0-9]+: 0x0000010d"));
  EXPECT_THAT(report, ContainsRegex("it goes the same way up to pc 0x8000002c.*, clock [0-9]+\\."));
  EXPECT_THAT(report, HasSubstr("Memory differs then at 0x80021008"));
  EXPECT_THAT(report, ContainsRegex("of 3 since HINT 2 \\(clock [0-9]+\\):\n"
                                    ".* addi a3, a2, 100 .*\n.* addi a0, a0, 1 .*\n.* sw a3, 8\\(s0\\) .*$"));
}

TEST(Lockstep, AStoreToAWrongPlaceIsFound) {
  const std::string report = report_with(13, sw(kA3, kS0, 12));
  EXPECT_THAT(report, AllOf(HasSubstr("HINT 3: local memory differs"), HasSubstr("That word, at 0x80021008")));
  EXPECT_THAT(report, ContainsRegex("word +0x0000010d +0x00000000 +0x0000010d"));
  // The other way round: what only the translated engine has stored, nobody has as interpreted.
  const std::string early = report_with(12, sw(kA0, kS0, -8));
  EXPECT_THAT(early, HasSubstr("That word, at 0x80020ff8"));
  EXPECT_THAT(early, HasSubstr("As interpreted, nothing has been stored there since the last HINT."));
}

TEST(Lockstep, AWrongCostIsFoundAtTheNextHint) {
  EXPECT_THAT(report_with(InstructionClass::store, 2),
              AllOf(HasSubstr("part at its HINT 1: the clocks differ"), HasSubstr("since the start (clock 0)")));
  EXPECT_THAT(report_with(InstructionClass::multiply, 4),
              AllOf(HasSubstr("part at its HINT 2: phase marker 1 (QEMU: 67 at clock "), HasSubstr(") differs")));
}

TEST(Lockstep, AnotherHintIsFound) {
  const std::string report = report_with(15, hint(Hint::receive_if_any));
  EXPECT_THAT(report, HasSubstr("part at its HINT 3: the HINTs differ"));
  EXPECT_THAT(report, ContainsRegex("HINT +clock +receive_if_any +clock"));
}

TEST(Lockstep, AnInstructionTooManyIsFound) {
  // Two cycles each: a jump to the next instruction but one, past an integer instruction, against two of them.
  const std::string report = report_with(11, j_type(0, 8));
  EXPECT_THAT(report, HasSubstr("part at its HINT 3: the numbers of instructions differ"));
}

TEST(Lockstep, OneThatDoesNotComeToTheHintIsFound) {
  EXPECT_THAT(report_with(14, j_type(0, 0)),
              HasSubstr("part at its HINT 3: the translated engine alone has met no HINT"));
  EXPECT_THAT(report_with(14, 0), HasSubstr("part at its HINT 3: the translated engine alone cannot go on"));
}

}  // namespace
}  // namespace torolux::test
