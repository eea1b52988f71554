// SPDX-License-Identifier: MIT
// Traps, control and status registers, memory protection, jumps to odd places: what a program sees of them is QEMU's.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/translated/runs.hpp"

namespace torolux::test {
namespace {

constexpr Reg kRa = 1, kT0 = 5, kT1 = 6, kT2 = 7, kLog = 20, kValue = 21, kAddress = 22;

/// A program with a trap handler that logs mcause, mepc, mtval and mstatus, and goes on behind the instruction, or
/// where ra says if it cannot be fetched.
Code begin_with_handler() {
  Code code;
  code.li(kLog, kData);
  const std::int32_t handler = code.here() + 16;
  code.li(kT0, 0x8000'0000U + static_cast<Word>(handler)) << csrrw(0, csr::kMtvec, kT0);
  const std::size_t skip = code.words().size();
  code << 0;
  const Word logged[] = {csr::kMcause, csr::kMepc, csr::kMtval, csr::kMstatus};
  std::int32_t offset = 0;
  for (const Word number : logged) {
    code << csrrs(kT1, number, 0) << sw(kT1, kLog, offset);
    offset += 4;
  }
  code << addi(kLog, kLog, 16);
  code << csrrs(kT1, csr::kMepc, 0) << csrrs(kT2, csr::kMcause, 0) << addi(kT1, kT1, 4) << addi(kT2, kT2, -1);
  code << bne(kT2, 0, 8) << addi(kT1, kRa, 0);
  code << csrrw(0, csr::kMepc, kT1) << 0x3020'0073U;  // mret
  code[skip] = j_type(0, code.here() - static_cast<std::int32_t>(4 * skip));
  return code;
}

/// As firmware/boot does: nothing before local memory, code, data, nothing behind. Entries 0 to 3 are used.
void lock_memory(Code& code) {
  constexpr Word kPmpaddr0 = 0x3B0, kPmpcfg0 = 0x3A0;
  const Word borders[] = {0x8000'0000U >> 2U, (kData - protocol::kPageBytes) >> 2U, kDataEnd >> 2U, 0xFFFF'FFFFU};
  for (Word i = 0; i < 4; ++i) code.li(kT0, borders[i]) << csrrw(0, kPmpaddr0 + i, kT0);
  code.li(kT0, 0x888B'8D88U) << csrrw(0, kPmpcfg0, kT0);
}

void turn_float_on(Code& code) {
  code.li(kT0, 0x2000) << csrrs(0, csr::kMstatus, kT0);
}

void finish(Code& code, const std::string& name, Counts counts) {
  code << sw(kLog, kLog, 0) << hint(protocol::Hint::halt);
  const Outcome outcome = run_on_all(image_of(code), name, {}, counts);
  EXPECT_TRUE(outcome.halted);
}

TEST(TranslatedControl, WhatIsNoInstructionTraps) {
  Code code = begin_with_handler();
  turn_float_on(code);
  const Word words[] = {0xFFFF'FFFFU,
                        0x02C5'F553U /* fadd.d */,
                        0x7C00'1073U /* csrw 0x7c0, x0 */,
                        0xF110'1073U /* csrw mvendorid, x0 */,
                        0x1020'0073U /* sret */,
                        0x0000'0073U /* ecall */,
                        0x0010'0073U /* ebreak */,
                        0x0000'000BU,
                        0x40B5'7533U /* andn */,
                        0x20B5'2533U /* sh1add */,
                        0x0AB5'1533U /* clmul */,
                        0x48B5'1533U /* bclr */,
                        0x00B5'5553U /* fadd.s with mode 5 */,
                        0x00B5'6553U /* mode 6 */};
  for (const Word word : words) code << word;
  code << csrrwi(0, csr::kFrm, 5) << 0x00B5'7553U /* fadd.s, dynamic */ << csrrwi(0, csr::kFrm, 0);
  code.li(kT0, 0x6000) << i_type(0x73, 3, 0, kT0, csr::kMstatus);  // float off
  code << 0x00B5'7553U << flw(1, kLog, 0) << fsw(1, kLog, 0) << csrrs(kT0, csr::kFrm, 0);
  turn_float_on(code);
  code << 0x00B5'7553U;
  finish(code, "no instruction", Counts::ignored);
}

TEST(TranslatedControl, AccessOutsideLocalMemoryTraps) {
  Code code = begin_with_handler();
  lock_memory(code);
  const Word addresses[] = {0,           0x1000'0000U, 0x7FFF'FFFFU, 0x7FFF'FFFCU, 0x8000'0000U, 0x8000'0100U,
                            kDataEnd,    kDataEnd - 1, kDataEnd - 2, kDataEnd - 4, 0xFFFF'FFFEU, 0x8400'0000U,
                            0x8002'0000U};
  code.li(kValue, 0x1234'5678U);
  // QEMU's mtval for an access across the end of memory depends on whether it has met the last page before.
  code.li(kAddress, kDataEnd - 64);
  code << lw(kT0, kAddress, 0) << sw(kT0, kAddress, 0);
  for (const Word address : addresses) {
    code.li(kAddress, address);
    code << lw(kValue, kAddress, 0) << i_type(0x03, 0, kValue, kAddress, 0) << i_type(0x03, 5, kValue, kAddress, 0);
    code << sw(kValue, kAddress, 0) << s_type(0x23, 0, kAddress, kValue, 0) << s_type(0x23, 1, kAddress, kValue, 0);
  }
  finish(code, "access", Counts::ignored);
}

/// Translated code checks once for several accesses by the same register, and looks ahead of branches for them. What is
/// outside still traps where it stands, what is inside still works; a copy of the register, and one that has moved on,
/// are as good as the register itself, and no better. A loop, because what follows a trap is interpreted until then.
TEST(TranslatedControl, ChecksThatCoverOtherAccessesLetNothingThrough) {
  Code code = begin_with_handler();
  lock_memory(code);
  constexpr Reg kCopy = 23, kMoved = 24, kTable = 25, kEnd = 26;
  constexpr Word kAddresses = kData + 0x8000U;
  const Word addresses[] = {kDataEnd - 128,
                            kDataEnd - 64,
                            kDataEnd - 60,
                            kDataEnd - 56,
                            kDataEnd - 36,
                            kDataEnd - 32,
                            kDataEnd - 12,
                            kDataEnd - 8,
                            kDataEnd - 4,
                            kDataEnd,
                            0x8000'0000U,
                            0x8000'0100U,
                            kAddresses - 4096,
                            kData - protocol::kPageBytes - 20,
                            kData - protocol::kPageBytes};
  code.li(kValue, 0x1234'5678U).li(kTable, kAddresses);
  for (const Word address : addresses) {
    code.li(kT0, address);
    code << sw(kT0, kTable, 0) << addi(kTable, kTable, 4);
  }
  code << addi(kEnd, kTable, 0);
  code.li(kTable, kAddresses);
  const std::int32_t begin = code.here();
  code << lw(kAddress, kTable, 0) << addi(kTable, kTable, 4);
  code << lw(kT0, kAddress, 0) << addi(kCopy, kAddress, 0) << addi(kMoved, kAddress, 24);
  code << bne(kTable, 0, 12) << lw(kT1, kAddress, 32) << sw(kValue, kAddress, 28);  // these two are never executed
  code << lw(kT1, kAddress, 8) << sw(kValue, kCopy, 4) << lw(kT2, kMoved, 32) << lw(kT2, kMoved, -16);
  code << sw(kValue, kMoved, 8);
  code << sw(kT0, kLog, 0) << sw(kT1, kLog, 4) << sw(kT2, kLog, 8) << addi(kLog, kLog, 12);
  code << bne(kTable, kEnd, begin - code.here());
  finish(code, "checks", Counts::ignored);
}

/// What a check says of a register says less of one that has moved on from it. Nothing else of the loop is outside, as
/// the interpreter would go on behind it.
TEST(TranslatedControl, AChecksReachMovesWithTheRegister) {
  Code code = begin_with_handler();
  lock_memory(code);
  constexpr Reg kMoved = 23, kEnd = 24;
  code.li(kAddress, kDataEnd - 128).li(kEnd, kDataEnd);
  const std::int32_t begin = code.here();
  code << lw(kT0, kAddress, 0) << addi(kMoved, kAddress, 24) << lw(kT1, kMoved, 0);
  code << sw(kT0, kLog, 0) << sw(kT1, kLog, 4) << addi(kLog, kLog, 8) << addi(kAddress, kAddress, 4);
  code << bne(kAddress, kEnd, begin - code.here());
  finish(code, "moved", Counts::ignored);
}

TEST(TranslatedControl, AtomicsTrapWhereTheyCannotWork) {
  Code code = begin_with_handler();
  lock_memory(code);
  const Word addresses[] = {0x1000'0000U, 0x8000'0000U, kDataEnd - 8, kDataEnd - 7, kDataEnd - 6, kDataEnd};
  const Word functions[] = {0x02, 0x03, 0x01, 0x00, 0x18};
  for (const Word address : addresses) {
    code.li(kAddress, address);
    for (const Word function : functions) {
      code << r_type(0x2F, 2, function << 2U, kValue, kAddress, function == 2 ? 0 : kLog) << sw(kValue, kLog, 0);
      code << addi(kLog, kLog, 16);
    }
  }
  finish(code, "atomics", Counts::ignored);
}

TEST(TranslatedControl, JumpsOutsideCodeTrap) {
  Code code = begin_with_handler();
  lock_memory(code);
  for (const Word address : {0x100U, 0x7FFF'FFFEU, kData, kDataEnd, 0xFFFF'FFF0U}) {
    code.li(kAddress, address);
    code << jalr(kRa, kAddress, 0) << addi(kValue, kValue, 1);
  }
  finish(code, "jumps", Counts::ignored);
}

TEST(TranslatedControl, JumpsReachEveryInstructionOfABlock) {
  Code code;
  code.li(kLog, kData).li(kAddress, 0);
  const std::size_t place = code.words().size() - 2;
  constexpr std::int32_t kLength = 10;
  // A table of jumps into one straight block, at each of its instructions; it returns by ra.
  for (std::int32_t i = 0; i < kLength; ++i) code << jalr(kRa, kAddress, 4 * i) << sw(kValue, kLog, 4 * i);
  // The upper half of this word is `c.addi kValue, 5`.
  code << jalr(kRa, kAddress, 4 * kLength + 2) << sw(kValue, kLog, 4 * kLength);
  code << hint(protocol::Hint::halt);
  const Word block = 0x8000'0000U + static_cast<Word>(code.here());
  for (std::int32_t i = 0; i < kLength; ++i) code << addi(kValue, kValue, 1 << i);
  code << (0x0001U | kValue << 7U | 5U << 2U) * 0x1'0000U + lui(kT0, 0) << jalr(0, kRa, 0);
  Code address;
  address.li(kAddress, block);
  code[place] = address[0];
  code[place + 1] = address[1];
  const Outcome outcome = run_on_all(image_of(code), "into a block");
  EXPECT_EQ(outcome.word(kData), 1023U);
  EXPECT_EQ(outcome.word(kData + 4 * (kLength - 1)) - outcome.word(kData + 4 * (kLength - 2)), 512U);
}

TEST(TranslatedControl, ReturnsGoWhereNoCallStands) {
  for (const bool calls : {true, false}) {
    Code code;
    code.li(kLog, kData).li(kRa, 0x8000'0000U + 4 * 8);
    while (code.here() < 4 * 7) code << addi(0, 0, 0);
    // The place behind it is reached by ret below.
    code << (calls ? j_type(kRa, 8) : j_type(0, 8)) << hint(protocol::Hint::halt) << jalr(0, kRa, 0);
    EXPECT_TRUE(run_on_all(image_of(code), "ret").halted);
  }
}

/// A handler whose address translation cannot know reads what nobody else does.
TEST(TranslatedControl, AnUnforeseenTrapHandlerSeesAllRegisters) {
  constexpr Word kDead = 27;
  Code code;
  const std::int32_t handler = 4 * 24;
  // Straight-line code sets one handler; the jump over it arrives with another.
  code.li(kLog, kData).li(kDead, 4711).li(kT1, 0x8000'0000U + handler) << j_type(0, 12);
  code.li(kT1, 0x8000'0000U + 4 * 20) << csrrw(0, csr::kMtvec, kT1) << 0U /* illegal */;
  while (code.here() < 4 * 20) code << hint(protocol::Hint::halt);
  while (code.here() < handler) code << hint(protocol::Hint::halt);
  code << sw(kDead, kLog, 0) << hint(protocol::Hint::halt);
  const Outcome outcome = run_on_all(image_of(code), "handler", {}, Counts::ignored);
  EXPECT_EQ(outcome.word(kData), 4711U);
}

/// Two functions. The first jumps by a register that an operation makes of two others to `place`, which is an
/// instruction of the first (behind the jump) or the second, or the beginning of the second.
enum class Place : std::uint8_t { own_function, other_function, beginning };
Image jump_to(Place place, bool by_sum, bool interpreted) {
  constexpr Reg kFrm = 1;
  Code code;
  turn_float_on(code);
  code << csrrwi(0, csr::kFrm, interpreted ? kFrm : 0) << 0x00B5'7553U /* fadd.s: else frm is of no interest */;
  constexpr std::int32_t kJump = 4 * 16;  // behind all that makes its register
  constexpr Word kSecond = 0x8000'0000U + kJump + 8;
  const Word target = place == Place::own_function ? kSecond - 4 : place == Place::beginning ? kSecond : kSecond + 4;
  constexpr Word kOther = 0x1357'9BDFU;  // neither this nor the other operand looks like an address of code
  code.li(kT1, by_sum ? target - kOther : target ^ kOther).li(kT2, kOther);
  code << r_type(0x33, by_sum ? 0 : 4, 0, kT0, kT1, kT2);
  while (code.here() < kJump) code << addi(0, 0, 0);
  code << jalr(0, kT0, 0) << hint(protocol::Hint::halt);
  code << addi(kValue, kValue, 1) << hint(protocol::Hint::halt);
  Image image = image_of(code);
  image.symbols.push_back({0x8000'0000U, kSecond - 0x8000'0000U, "first", true});
  image.symbols.push_back({kSecond, 8, "second", true});
  std::ranges::sort(image.symbols, {}, &ImageSymbol::address);
  return image;
}

/// The count of instructions tells whether it went there.
TEST(TranslatedControl, JumpsThatNobodyCouldForeseeGoOn) {
  for (const bool interpreted : {false, true}) {
    for (const bool by_sum : {false, true}) {
      for (const Place place : {Place::own_function, Place::other_function, Place::beginning}) {
        const std::string label = "place " + std::to_string(static_cast<int>(place)) + (by_sum ? ", sum" : "");
        EXPECT_TRUE(run_on_all(jump_to(place, by_sum, interpreted), label).halted) << label;
      }
    }
  }
}

TEST(TranslatedControl, CountersAreThePesClockAndInstructions) {
  Code code;
  code.li(kLog, kData);
  const Word numbers[] = {0xC00, 0xC01, 0xB00, 0xC02, 0xB02, 0xC80, 0xC81, 0xB80, 0xC82, 0xB82};
  std::int32_t offset = 0;
  for (const Word number : numbers) code << csrrs(kT0, number, 0) << sw(kT0, kLog, 4 * offset++);
  code << csrrs(kT0, 0xC00, 0) << csrrs(kT1, 0xC00, 0) << sw(kT0, kLog, 40) << sw(kT1, kLog, 44);
  code << hint(protocol::Hint::halt);
  const Outcome outcome = run_on_all(image_of(code), "counters");
  ASSERT_TRUE(outcome.halted) << outcome.failure;
  const auto word = [&](Word n) { return outcome.word(kData + 4 * n); };
  EXPECT_EQ(word(3), 2U + 2 * 3 + 1);  // li is two; csrr, sw three times; and itself
  EXPECT_EQ(word(4), word(3) + 2);
  for (Word high = 5; high < 10; ++high) EXPECT_EQ(word(high), 0U);
  EXPECT_GT(word(1), word(0));
  EXPECT_GT(word(2), word(1));
  EXPECT_LT(word(11), outcome.clock);
  EXPECT_EQ(word(11) - word(10), 1U);  // one instruction of the class `integer`
}

/// By all instructions that read only; what is read decides where the program goes.
TEST(TranslatedControl, CountersInALoopAreAlike) {
  Code code;
  code.li(kLog, kData);
  code.li(kT1, 200);
  const std::size_t loop = code.words().size();
  for (const Word kind : {2U, 3U, 6U, 7U}) {
    for (const Word number : {0xC00U, 0xC02U}) {
      code << i_type(0x73, kind, kT0, 0, static_cast<int>(number) - 0x1000) << sw(kT0, kLog, 0) << addi(kLog, kLog, 4);
    }
  }
  code << csrrs(0, 0xC00, 0);                                    // into the register that is always 0
  code << csrrs(kT0, 0xB00, 0) << i_type(0x13, 7, kT0, kT0, 1);  // andi: whether the clock is odd
  code << bne(kT0, 0, 12) << sw(kLog, kLog, 0) << addi(kLog, kLog, 4);
  code << addi(kT1, kT1, -1);
  code << bne(kT1, 0, static_cast<std::int32_t>(loop - code.words().size()) * 4);
  code << hint(protocol::Hint::halt);
  EXPECT_TRUE(run_on_all(image_of(code), "counters in a loop").halted);
}

TEST(TranslatedControl, RegistersKeepWhatTheyCan) {
  Code code = begin_with_handler();
  turn_float_on(code);
  const Word numbers[] = {0x001, 0x002, 0x003, 0x300, 0x301, 0x304, 0x310, 0x340, 0x341, 0x342,
                          0x343, 0x344, 0x3A0, 0x3A1, 0x3A3, 0x3B0, 0x3B7, 0x3BF, 0xF14, 0xF11};
  const Word values[] = {0xFFFF'FFFFU, 0x5555'5555U, 0};
  for (const Word number : numbers) {
    // Nothing that would deny access or lend rights.
    const Word mask = number == 0x300 ? 0xFFFD'E7FFU : number >= 0x3A0 && number < 0x3B0 ? 0x6060'6060U : 0xFFFF'FFFFU;
    for (const Word value : values) {
      code.li(kValue, value & mask);
      code << csrrw(kT0, number, kValue) << sw(kT0, kLog, 0);
      code << csrrs(kT0, number, kValue) << sw(kT0, kLog, 4) << i_type(0x73, 3, kT0, kValue, static_cast<int>(number));
      code << sw(kT0, kLog, 8) << csrrs(kT0, number, 0) << sw(kT0, kLog, 12) << addi(kLog, kLog, 16);
    }
    if (number == 0x300) turn_float_on(code);
  }
  finish(code, "registers", Counts::ignored);
}

TEST(TranslatedControl, StartsWithTheRegistersOfTheBootRom) {
  Code code;
  for (Reg r = 1; r < 32; ++r) {
    if (r == kLog) code.li(kLog, kData);
    if (r > kLog) code << sw(r, kLog, static_cast<std::int32_t>(4 * r));
  }
  for (Reg r = 1; r < kLog; ++r) code << sw(r, kLog, static_cast<std::int32_t>(4 * r));
  code << hint(protocol::Hint::halt);
  const Outcome outcome = run_on_all(image_of(code), "start");
  EXPECT_EQ(outcome.word(kData + 4 * kT0), 0x8000'0000U);
}

}  // namespace
}  // namespace torolux::test
