// SPDX-License-Identifier: MIT
// Every instruction that computes, with corner operands, in all rounding modes, with its flags: equal on QEMU,
// interpreted and translated.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <random>
#include <string>

#include "tests/translated/runs.hpp"

namespace torolux::test {
namespace {

constexpr Reg kOperands = 10, kEnd = 11, kResults = 12, kA = 13, kB = 14, kC = 15, kRd = 16, kFlags = 17, kScratch = 5;
constexpr std::size_t kTuples = 1600;
constexpr std::size_t kTupleBytes = 12, kResultBytes = 8;

/// Values at which floating point or integers change their behaviour.
constexpr std::array<Word, 48> kCorners = {
    0x00000000, 0x80000000, 0x00000001, 0x80000001, 0x007FFFFF, 0x807FFFFF, 0x00800000, 0x80800000,
    0x00800001, 0x3F800000, 0xBF800000, 0x3F800001, 0x3F7FFFFF, 0x40000000, 0xC0000000, 0x40400000,
    0x3F000000, 0xBF000000, 0x3FC00000, 0xBFC00000, 0x40200000, 0x3EFFFFFF, 0x7F7FFFFF, 0xFF7FFFFF,
    0x7F800000, 0xFF800000, 0x7FC00000, 0xFFC00000, 0x7FC12345, 0x7F800001, 0xFF812345, 0x7FFFFFFF,
    0x4F000000, 0xCF000000, 0x4EFFFFFF, 0x4F7FFFFF, 0x4F800000, 0xCF000001, 0x34000000, 0x1F800000,
    0x20000000, 0x5F000000, 0x00000002, 0x0000FFFF, 0xFFFFFFFE, 0x7FFFFFFE, 0x12345678, 0x4B800001};

/// Tuples of operands: all pairs of the first corners, then corners and random bits.
void fill_operands(std::span<std::byte> memory) {
  std::mt19937 random(20261122);
  const auto any = [&] {
    const Word bits = static_cast<Word>(random());
    return bits % 3 == 0 ? static_cast<Word>(random()) : kCorners[bits / 3 % kCorners.size()];
  };
  std::vector<Word> words;
  for (std::size_t i = 0; i < kTuples; ++i) {
    constexpr std::size_t kPaired = 32;
    const bool paired = i < kPaired * kPaired;
    const Word near = static_cast<Word>(random() % 64) - 32;
    const Word a = paired ? kCorners[i / kPaired] : any();
    words.push_back(a);
    words.push_back(paired ? kCorners[i % kPaired] : random() % 4 == 0 ? a + near : any());
    words.push_back(any());
  }
  std::memcpy(memory.data() + (kData - protocol::kLocalMemoryBase), words.data(), 4 * words.size());
}

enum class Kind : std::uint8_t { x_to_x, x_to_f, f_to_x, f_to_f };

/// A loop over all operands for one instruction; result and flags go to memory.
void add_loop(Code& code, Word instruction, Kind kind) {
  const bool from_f = kind == Kind::f_to_x || kind == Kind::f_to_f;
  const bool to_f = kind == Kind::x_to_f || kind == Kind::f_to_f;
  code.li(kOperands, kData).li(kEnd, kData + kTuples * kTupleBytes);
  const std::int32_t begin = code.here();
  for (Reg r = 0; r < 3; ++r) {
    const auto offset = static_cast<std::int32_t>(4 * r);
    code << (from_f ? flw(kA + r, kOperands, offset) : lw(kA + r, kOperands, offset));
  }
  code << csrrwi(0, csr::kFflags, 0) << instruction << csrrs(kFlags, csr::kFflags, 0);
  code << (to_f ? fsw(kRd, kResults, 0) : sw(kRd, kResults, 0)) << sw(kFlags, kResults, 4);
  code << addi(kOperands, kOperands, kTupleBytes) << addi(kResults, kResults, kResultBytes);
  code << bne(kOperands, kEnd, begin - code.here());
}

Code begin_program() {
  Code code;
  code.li(kScratch, 0x2000) << csrrs(0, csr::kMstatus, kScratch);
  code.li(kResults, kData + kTuples * kTupleBytes);
  return code;
}

void finish_and_compare(Code& code, const std::string& name) {
  code << csrrs(kFlags, csr::kMstatus, 0) << sw(kFlags, kResults, 0) << hint(protocol::Hint::halt);
  const Outcome outcome = run_on_all(image_of(code), name, fill_operands);
  EXPECT_GT(outcome.instructions, kTuples * 10);
}

/// Instructions without rounding mode, several loops to a program.
class Plain {
 public:
  Plain() = default;
  Plain(const Plain&) = delete;
  Plain& operator=(const Plain&) = delete;
  ~Plain() { finish(); }

  void check(const std::string& name, Word instruction, Kind kind) {
    constexpr unsigned kMostLoops = 8;  // as many results as there is memory for
    if (loops_ == kMostLoops) finish();
    add_loop(code_, instruction, kind);
    names_ += name + " ";
    ++loops_;
  }

 private:
  void finish() {
    if (loops_ != 0) finish_and_compare(code_, names_);
    code_ = begin_program();
    names_.clear();
    loops_ = 0;
  }

  Code code_ = begin_program();
  std::string names_;
  unsigned loops_ = 0;
};

/// With each static mode in one program, and dynamically with each mode in frm in another.
void check_rounding(const std::string& name, Word instruction, Kind kind) {
  constexpr Word kModes = 5;
  Code fixed = begin_program();
  for (Word mode = 0; mode < kModes; ++mode) add_loop(fixed, instruction | mode << 12U, kind);
  finish_and_compare(fixed, name + " with static modes");
  Code dynamic = begin_program();
  for (Word mode = 0; mode < kModes; ++mode) {
    dynamic << csrrwi(0, csr::kFrm, mode);
    add_loop(dynamic, instruction | 7U << 12U, kind);
  }
  finish_and_compare(dynamic, name + " with dynamic modes");
}

Word float_op(Word funct7, Word funct3, Reg rs2 = kB) {
  return r_type(0x53, funct3, funct7, kRd, kA, rs2);
}

TEST(TranslatedInstructions, IntegerOfTwoRegisters) {
  Plain plain;
  const char* base[] = {"add", "sll", "slt", "sltu", "xor", "srl", "or", "and"};
  const char* multiply[] = {"mul", "mulh", "mulhsu", "mulhu", "div", "divu", "rem", "remu"};
  for (Word f3 = 0; f3 < 8; ++f3) {
    plain.check(base[f3], r_type(0x33, f3, 0x00, kRd, kA, kB), Kind::x_to_x);
    plain.check(multiply[f3], r_type(0x33, f3, 0x01, kRd, kA, kB), Kind::x_to_x);
  }
  plain.check("sub", r_type(0x33, 0, 0x20, kRd, kA, kB), Kind::x_to_x);
  plain.check("sra", r_type(0x33, 5, 0x20, kRd, kA, kB), Kind::x_to_x);
}

TEST(TranslatedInstructions, IntegerWithImmediate) {
  Plain plain;
  for (const std::int32_t immediate : {-2048, -1, 0, 1, 31, 2047}) {
    for (const Word f3 : {0U, 2U, 3U, 4U, 6U, 7U}) {
      plain.check("op-imm " + std::to_string(f3), i_type(0x13, f3, kRd, kA, immediate), Kind::x_to_x);
    }
  }
  for (const std::int32_t shift : {0, 1, 31}) {
    plain.check("slli", i_type(0x13, 1, kRd, kA, shift), Kind::x_to_x);
    plain.check("srli", i_type(0x13, 5, kRd, kA, shift), Kind::x_to_x);
    plain.check("srai", i_type(0x13, 5, kRd, kA, shift | 0x400), Kind::x_to_x);
  }
}

TEST(TranslatedInstructions, FloatThatRounds) {
  check_rounding("fadd.s", float_op(0x00, 0), Kind::f_to_f);
  check_rounding("fsub.s", float_op(0x04, 0), Kind::f_to_f);
  check_rounding("fmul.s", float_op(0x08, 0), Kind::f_to_f);
  check_rounding("fdiv.s", float_op(0x0C, 0), Kind::f_to_f);
  check_rounding("fsqrt.s", float_op(0x2C, 0, 0), Kind::f_to_f);
}

TEST(TranslatedInstructions, FloatFused) {
  const char* names[] = {"fmadd.s", "fmsub.s", "fnmsub.s", "fnmadd.s"};
  for (Word which = 0; which < 4; ++which) {
    check_rounding(names[which], kC << 27U | r_type(0x43 + 4 * which, 0, 0, kRd, kA, kB), Kind::f_to_f);
  }
}

TEST(TranslatedInstructions, FloatConversions) {
  check_rounding("fcvt.w.s", float_op(0x60, 0, 0), Kind::f_to_x);
  check_rounding("fcvt.wu.s", float_op(0x60, 0, 1), Kind::f_to_x);
  check_rounding("fcvt.s.w", float_op(0x68, 0, 0), Kind::x_to_f);
  check_rounding("fcvt.s.wu", float_op(0x68, 0, 1), Kind::x_to_f);
}

TEST(TranslatedInstructions, FloatThatDoesNotRound) {
  Plain plain;
  for (Word f3 = 0; f3 < 3; ++f3) {
    plain.check("fsgnj " + std::to_string(f3), float_op(0x10, f3), Kind::f_to_f);
    plain.check("compare " + std::to_string(f3), float_op(0x50, f3), Kind::f_to_x);
  }
  plain.check("fmin.s", float_op(0x14, 0), Kind::f_to_f);
  plain.check("fmax.s", float_op(0x14, 1), Kind::f_to_f);
  plain.check("fmv.x.w", float_op(0x70, 0, 0), Kind::f_to_x);
  plain.check("fclass.s", float_op(0x70, 1, 0), Kind::f_to_x);
  plain.check("fmv.w.x", float_op(0x78, 0, 0), Kind::x_to_f);
}

}  // namespace
}  // namespace torolux::test
