// SPDX-License-Identifier: MIT
// Instructions for test programs: names and operands in, words out.
#pragma once

#include <cstdint>
#include <vector>

#include "firmware/protocol/hints.hpp"

namespace torolux::test {

using Word = std::uint32_t;
using Reg = std::uint32_t;

constexpr Word r_type(Word opcode, Word funct3, Word funct7, Reg rd, Reg rs1, Reg rs2) {
  return funct7 << 25U | rs2 << 20U | rs1 << 15U | funct3 << 12U | rd << 7U | opcode;
}
constexpr Word i_type(Word opcode, Word funct3, Reg rd, Reg rs1, std::int32_t immediate) {
  return static_cast<Word>(immediate) << 20U | rs1 << 15U | funct3 << 12U | rd << 7U | opcode;
}
constexpr Word s_type(Word opcode, Word funct3, Reg rs1, Reg rs2, std::int32_t immediate) {
  const auto bits = static_cast<Word>(immediate);
  return (bits >> 5U & 0x7FU) << 25U | rs2 << 20U | rs1 << 15U | funct3 << 12U | (bits & 0x1FU) << 7U | opcode;
}
constexpr Word b_type(Word funct3, Reg rs1, Reg rs2, std::int32_t offset) {
  const auto bits = static_cast<Word>(offset);
  return (bits >> 12U & 1U) << 31U | (bits >> 5U & 0x3FU) << 25U | rs2 << 20U | rs1 << 15U | funct3 << 12U |
         (bits >> 1U & 0xFU) << 8U | (bits >> 11U & 1U) << 7U | 0x63U;
}
constexpr Word j_type(Reg rd, std::int32_t offset) {
  const auto bits = static_cast<Word>(offset);
  return (bits >> 20U & 1U) << 31U | (bits >> 1U & 0x3FFU) << 21U | (bits >> 11U & 1U) << 20U |
         (bits >> 12U & 0xFFU) << 12U | rd << 7U | 0x6FU;
}

constexpr Word addi(Reg rd, Reg rs1, std::int32_t immediate) {
  return i_type(0x13, 0, rd, rs1, immediate);
}
constexpr Word lui(Reg rd, Word value) {
  return (value & 0xFFFF'F000U) | rd << 7U | 0x37U;
}
constexpr Word lw(Reg rd, Reg rs1, std::int32_t offset) {
  return i_type(0x03, 2, rd, rs1, offset);
}
constexpr Word sw(Reg rs2, Reg rs1, std::int32_t offset) {
  return s_type(0x23, 2, rs1, rs2, offset);
}
constexpr Word flw(Reg rd, Reg rs1, std::int32_t offset) {
  return i_type(0x07, 2, rd, rs1, offset);
}
constexpr Word fsw(Reg rs2, Reg rs1, std::int32_t offset) {
  return s_type(0x27, 2, rs1, rs2, offset);
}
constexpr Word jalr(Reg rd, Reg rs1, std::int32_t offset) {
  return i_type(0x67, 0, rd, rs1, offset);
}
constexpr Word bne(Reg rs1, Reg rs2, std::int32_t offset) {
  return b_type(1, rs1, rs2, offset);
}
constexpr Word csrrw(Reg rd, Word csr, Reg rs1) {
  return i_type(0x73, 1, rd, rs1, static_cast<std::int32_t>(csr));
}
constexpr Word csrrs(Reg rd, Word csr, Reg rs1) {
  return i_type(0x73, 2, rd, rs1, static_cast<std::int32_t>(csr));
}
constexpr Word csrrwi(Reg rd, Word csr, Word value) {
  return i_type(0x73, 5, rd, value, static_cast<std::int32_t>(csr));
}
constexpr Word hint(protocol::Hint operation) {
  return protocol::hint_instruction(static_cast<std::int32_t>(operation));
}

namespace csr {
inline constexpr Word kFflags = 0x001, kFrm = 0x002, kFcsr = 0x003, kMstatus = 0x300, kMtvec = 0x305;
inline constexpr Word kMepc = 0x341, kMcause = 0x342, kMtval = 0x343;
}  // namespace csr

/// A program under construction.
class Code {
 public:
  Code& operator<<(Word instruction) {
    words_.push_back(instruction);
    return *this;
  }
  /// rd = value, by two instructions.
  Code& li(Reg rd, Word value) {
    const Word high = value + 0x800U;
    return *this << lui(rd, high) << addi(rd, rd, static_cast<std::int32_t>(value << 20U) >> 20);
  }
  /// Bytes so far: offsets of jumps are differences of these.
  std::int32_t here() const { return static_cast<std::int32_t>(4 * words_.size()); }
  Word& operator[](std::size_t index) { return words_[index]; }
  const std::vector<Word>& words() const { return words_; }

 private:
  std::vector<Word> words_;
};

}  // namespace torolux::test
