// SPDX-License-Identifier: MIT
// Expands compressed instructions.
#include "emulator/engines/translated/decode/compressed.hpp"

#include <array>

namespace torolux::translated {
namespace {

constexpr std::uint32_t field(std::uint32_t bits, unsigned low, unsigned count) {
  return (bits >> low) & ((1U << count) - 1U);
}
/// Bits [low, low + count) of the instruction, placed at `to` of an immediate.
constexpr std::uint32_t place(std::uint32_t bits, unsigned low, unsigned count, unsigned to) {
  return field(bits, low, count) << to;
}
constexpr std::uint32_t signed_from(std::uint32_t value, unsigned sign_bit) {
  const std::uint32_t sign = 1U << sign_bit;
  return (value ^ sign) - sign;
}
constexpr std::uint8_t full_register(std::uint32_t bits, unsigned low) {
  return static_cast<std::uint8_t>(field(bits, low, 5));
}
/// x8 to x15, f8 to f15.
constexpr std::uint8_t short_register(std::uint32_t bits, unsigned low) {
  return static_cast<std::uint8_t>(8U + field(bits, low, 3));
}
constexpr std::uint32_t immediate_6(std::uint32_t bits) {
  return signed_from(place(bits, 12, 1, 5) | place(bits, 2, 5, 0), 5);
}
constexpr std::uint32_t jump_offset(std::uint32_t b) {
  return signed_from(place(b, 12, 1, 11) | place(b, 11, 1, 4) | place(b, 9, 2, 8) | place(b, 8, 1, 10) |
                         place(b, 7, 1, 6) | place(b, 6, 1, 7) | place(b, 3, 3, 1) | place(b, 2, 1, 5),
                     11);
}
constexpr std::uint32_t branch_offset(std::uint32_t b) {
  return signed_from(
      place(b, 12, 1, 8) | place(b, 10, 2, 3) | place(b, 5, 2, 6) | place(b, 3, 2, 1) | place(b, 2, 1, 5), 8);
}

constexpr std::uint8_t kZero = 0, kRa = 1, kSp = 2;

class Expander {
 public:
  explicit Expander(Instruction& out) : out_(out), bits_(out.bits) {}

  void quadrant_0();
  void quadrant_1();
  void quadrant_2();

 private:
  void immediate(Op op, std::uint8_t rd, std::uint8_t rs1, std::uint32_t value) {
    out_.op = op;
    out_.rd = rd;
    out_.rs1 = rs1;
    out_.immediate = value;
  }
  void store(Op op, std::uint8_t rs1, std::uint8_t rs2, std::uint32_t value) {
    out_.op = op;
    out_.rs1 = rs1;
    out_.rs2 = rs2;
    out_.immediate = value;
  }
  void registers(Op op, std::uint8_t rd, std::uint8_t rs1, std::uint8_t rs2) {
    out_.op = op;
    out_.rd = rd;
    out_.rs1 = rs1;
    out_.rs2 = rs2;
  }
  void arithmetic();

  Instruction& out_;
  std::uint32_t bits_;
};

void Expander::quadrant_0() {
  const std::uint8_t low = short_register(bits_, 2);
  const std::uint8_t high = short_register(bits_, 7);
  const std::uint32_t offset = place(bits_, 10, 3, 3) | place(bits_, 6, 1, 2) | place(bits_, 5, 1, 6);
  switch (field(bits_, 13, 3)) {
    case 0:
      return immediate(Op::addi, low, kSp,
                       place(bits_, 11, 2, 4) | place(bits_, 7, 4, 6) | place(bits_, 6, 1, 2) | place(bits_, 5, 1, 3));
    case 2:
      return immediate(Op::lw, low, high, offset);
    case 3:
      return immediate(Op::flw, low, high, offset);
    case 6:
      return store(Op::sw, high, low, offset);
    default:
      return store(Op::fsw, high, low, offset);
  }
}

void Expander::arithmetic() {
  const std::uint8_t rd = short_register(bits_, 7);
  switch (field(bits_, 10, 2)) {
    case 0:
      return immediate(Op::srli, rd, rd, field(bits_, 2, 5));
    case 1:
      return immediate(Op::srai, rd, rd, field(bits_, 2, 5));
    case 2:
      return immediate(Op::andi, rd, rd, immediate_6(bits_));
    default:
      constexpr std::array kOps = {Op::sub, Op::xor_, Op::or_, Op::and_};
      return registers(kOps[field(bits_, 5, 2)], rd, rd, short_register(bits_, 2));
  }
}

void Expander::quadrant_1() {
  const std::uint8_t rd = full_register(bits_, 7);
  switch (field(bits_, 13, 3)) {
    case 0:
      return immediate(Op::addi, rd, rd, immediate_6(bits_));
    case 1:
      return immediate(Op::jal, kRa, kZero, jump_offset(bits_));
    case 2:
      return immediate(Op::addi, rd, kZero, immediate_6(bits_));
    case 3:
      if (rd != kSp) return immediate(Op::lui, rd, kZero, immediate_6(bits_) << 12U);
      return immediate(Op::addi, kSp, kSp,
                       signed_from(place(bits_, 12, 1, 9) | place(bits_, 6, 1, 4) | place(bits_, 5, 1, 6) |
                                       place(bits_, 3, 2, 7) | place(bits_, 2, 1, 5),
                                   9));
    case 4:
      return arithmetic();
    case 5:
      return immediate(Op::jal, kZero, kZero, jump_offset(bits_));
    case 6:
      return store(Op::beq, short_register(bits_, 7), kZero, branch_offset(bits_));
    default:
      return store(Op::bne, short_register(bits_, 7), kZero, branch_offset(bits_));
  }
}

void Expander::quadrant_2() {
  const std::uint8_t rd = full_register(bits_, 7);
  const std::uint8_t rs2 = full_register(bits_, 2);
  const std::uint32_t load_offset = place(bits_, 12, 1, 5) | place(bits_, 4, 3, 2) | place(bits_, 2, 2, 6);
  const std::uint32_t store_offset = place(bits_, 9, 4, 2) | place(bits_, 7, 2, 6);
  switch (field(bits_, 13, 3)) {
    case 0:
      return immediate(Op::slli, rd, rd, field(bits_, 2, 5));
    case 2:
      return immediate(Op::lw, rd, kSp, load_offset);
    case 3:
      return immediate(Op::flw, rd, kSp, load_offset);
    case 6:
      return store(Op::sw, kSp, rs2, store_offset);
    case 7:
      return store(Op::fsw, kSp, rs2, store_offset);
    default:
      break;
  }
  const bool bit_12 = field(bits_, 12, 1) != 0;
  if (rs2 != 0) return bit_12 ? registers(Op::add, rd, rd, rs2) : registers(Op::add, rd, kZero, rs2);
  if (rd == 0) return immediate(Op::ebreak, kZero, kZero, 0);
  return immediate(Op::jalr, bit_12 ? kRa : kZero, rd, 0);
}

}  // namespace

void decode_compressed(Instruction& out) {
  Expander expander(out);
  switch (out.bits & 3U) {
    case 0:
      return expander.quadrant_0();
    case 1:
      return expander.quadrant_1();
    default:
      return expander.quadrant_2();
  }
}

}  // namespace torolux::translated
