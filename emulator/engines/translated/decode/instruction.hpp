// SPDX-License-Identifier: MIT
// One instruction of RV32IMAFC_Zicsr_Zifencei, decoded: bits in, fields out. Compressed ones become what they stand
// for.
#pragma once

#include <cstdint>

namespace torolux::translated {

enum class Op : std::uint8_t {
  // Bits that are no instruction of the machine.
  illegal,
  // Integer.
  lui,
  auipc,
  addi,
  slti,
  sltiu,
  xori,
  ori,
  andi,
  slli,
  srli,
  srai,
  add,
  sub,
  sll,
  slt,
  sltu,
  xor_,
  srl,
  sra,
  or_,
  and_,
  mul,
  mulh,
  mulhsu,
  mulhu,
  div,
  divu,
  rem,
  remu,
  // Control.
  jal,
  jalr,
  beq,
  bne,
  blt,
  bge,
  bltu,
  bgeu,
  // Memory.
  lb,
  lh,
  lw,
  lbu,
  lhu,
  sb,
  sh,
  sw,
  flw,
  fsw,
  // Atomic.
  lr,
  sc,
  amoswap,
  amoadd,
  amoxor,
  amoand,
  amoor,
  amomin,
  amomax,
  amominu,
  amomaxu,
  // Floating point.
  fmadd,
  fmsub,
  fnmsub,
  fnmadd,
  fadd,
  fsub,
  fmul,
  fdiv,
  fsqrt,
  fsgnj,
  fsgnjn,
  fsgnjx,
  fmin,
  fmax,
  fcvt_w_s,
  fcvt_wu_s,
  fmv_x_w,
  feq,
  flt,
  fle,
  fclass,
  fcvt_s_w,
  fcvt_s_wu,
  fmv_w_x,
  // System.
  hint,
  fence,
  fence_i,
  ecall,
  ebreak,
  mret,
  wfi,
  csrrw,
  csrrs,
  csrrc,
  csrrwi,
  csrrsi,
  csrrci,
};

/// Rounding mode "as frm says".
inline constexpr std::uint8_t kDynamic = 7;

struct Instruction {
  Op op;
  std::uint8_t bytes;              ///< 2 or 4
  std::uint8_t rd, rs1, rs2, rs3;  ///< rs1 is the immediate of csrr?i
  std::uint8_t rounding;           ///< field rm
  std::uint32_t immediate;         ///< sign-extended; of csr*: the register's number
  std::uint32_t bits;              ///< as in memory; the upper half is 0 where bytes is 2
};

/// bits: of a compressed instruction the upper half is ignored.
Instruction decode(std::uint32_t bits);

bool is_float(Op op);                 ///< needs mstatus.FS on (loads and stores of f registers, too)
bool writes_f(Op op);                 ///< rd is an f register
bool writes_x(Op op);                 ///< rd is an x register
bool is_branch(Op op);                ///< conditional
bool is_access(Op op);                ///< load or store, not atomic
bool is_store(Op op);                 ///< likewise
std::uint32_t accessed_bytes(Op op);  ///< of a load, a store or an atomic instruction: 1, 2 or 4
bool is_csr(Op op);                   ///< csr*

}  // namespace torolux::translated
