// SPDX-License-Identifier: MIT
// Decodes 4-byte instructions. What exists is decided by engines/isa, so that costs and meanings cannot disagree.
#include "emulator/engines/translated/decode/instruction.hpp"

#include <array>

#include "emulator/engines/isa/instruction_class.hpp"
#include "emulator/engines/translated/decode/compressed.hpp"
#include "firmware/protocol/hints.hpp"

namespace torolux::translated {
namespace {

constexpr std::uint32_t field(std::uint32_t bits, unsigned low, unsigned count) {
  return (bits >> low) & ((1U << count) - 1U);
}
constexpr std::uint8_t register_at(std::uint32_t bits, unsigned low) {
  return static_cast<std::uint8_t>(field(bits, low, 5));
}
constexpr std::uint32_t signed_from(std::uint32_t value, unsigned sign_bit) {
  const std::uint32_t sign = 1U << sign_bit;
  return (value ^ sign) - sign;
}
constexpr std::uint32_t immediate_i(std::uint32_t bits) {
  return signed_from(field(bits, 20, 12), 11);
}
constexpr std::uint32_t immediate_s(std::uint32_t bits) {
  return signed_from(field(bits, 25, 7) << 5U | field(bits, 7, 5), 11);
}
constexpr std::uint32_t immediate_b(std::uint32_t bits) {
  return signed_from(
      field(bits, 31, 1) << 12U | field(bits, 7, 1) << 11U | field(bits, 25, 6) << 5U | field(bits, 8, 4) << 1U, 12);
}
constexpr std::uint32_t immediate_j(std::uint32_t bits) {
  return signed_from(
      field(bits, 31, 1) << 20U | field(bits, 12, 8) << 12U | field(bits, 20, 1) << 11U | field(bits, 21, 10) << 1U,
      20);
}

Op op_immediate(std::uint32_t bits) {
  constexpr std::array kOps = {Op::addi, Op::slli, Op::slti, Op::sltiu, Op::xori, Op::srli, Op::ori, Op::andi};
  const Op op = kOps[field(bits, 12, 3)];
  return op == Op::srli && field(bits, 30, 1) != 0 ? Op::srai : op;
}

Op op_register(std::uint32_t bits) {
  constexpr std::array kBase = {Op::add, Op::sll, Op::slt, Op::sltu, Op::xor_, Op::srl, Op::or_, Op::and_};
  constexpr std::array kMultiply = {Op::mul, Op::mulh, Op::mulhsu, Op::mulhu, Op::div, Op::divu, Op::rem, Op::remu};
  const std::uint32_t f3 = field(bits, 12, 3);
  switch (field(bits, 25, 7)) {
    case 0x01:
      return kMultiply[f3];
    case 0x20:
      return f3 == 0 ? Op::sub : Op::sra;
    default:
      return kBase[f3];
  }
}

Op atomic(std::uint32_t bits) {
  switch (field(bits, 27, 5)) {
    case 0x02:
      return Op::lr;
    case 0x03:
      return Op::sc;
    case 0x01:
      return Op::amoswap;
    case 0x00:
      return Op::amoadd;
    case 0x04:
      return Op::amoxor;
    case 0x0C:
      return Op::amoand;
    case 0x08:
      return Op::amoor;
    case 0x10:
      return Op::amomin;
    case 0x14:
      return Op::amomax;
    case 0x18:
      return Op::amominu;
    default:
      return Op::amomaxu;
  }
}

Op op_float(std::uint32_t bits) {
  const std::uint32_t f3 = field(bits, 12, 3);
  const bool second = field(bits, 20, 5) != 0;
  switch (field(bits, 25, 7)) {
    case 0x00:
      return Op::fadd;
    case 0x04:
      return Op::fsub;
    case 0x08:
      return Op::fmul;
    case 0x0C:
      return Op::fdiv;
    case 0x2C:
      return Op::fsqrt;
    case 0x10:
      return std::array{Op::fsgnj, Op::fsgnjn, Op::fsgnjx}[f3];
    case 0x50:
      return std::array{Op::fle, Op::flt, Op::feq}[f3];
    case 0x14:
      return f3 == 0 ? Op::fmin : Op::fmax;
    case 0x60:
      return second ? Op::fcvt_wu_s : Op::fcvt_w_s;
    case 0x68:
      return second ? Op::fcvt_s_wu : Op::fcvt_s_w;
    case 0x70:
      return f3 == 0 ? Op::fmv_x_w : Op::fclass;
    default:
      return Op::fmv_w_x;
  }
}

Op system(std::uint32_t bits) {
  constexpr std::array kCsr = {Op::illegal, Op::csrrw,  Op::csrrs,  Op::csrrc,
                               Op::illegal, Op::csrrwi, Op::csrrsi, Op::csrrci};
  if (field(bits, 12, 3) != 0) return kCsr[field(bits, 12, 3)];
  switch (field(bits, 20, 12)) {
    case 0x000:
      return Op::ecall;
    case 0x001:
      return Op::ebreak;
    case 0x302:
      return Op::mret;
    default:
      return Op::wfi;
  }
}

/// Operation and immediate; registers are where they always are.
void decode_full(Instruction& out) {
  constexpr std::array kBranches = {Op::beq, Op::bne, Op::illegal, Op::illegal, Op::blt, Op::bge, Op::bltu, Op::bgeu};
  constexpr std::array kLoads = {Op::lb, Op::lh, Op::lw, Op::illegal, Op::lbu, Op::lhu};
  constexpr std::array kStores = {Op::sb, Op::sh, Op::sw};
  const std::uint32_t bits = out.bits;
  const std::uint32_t f3 = field(bits, 12, 3);
  const auto set = [&](Op op, std::uint32_t immediate = 0) {
    out.op = op;
    out.immediate = immediate;
  };
  switch (bits & 0x7FU) {
    case 0x37:
      return set(Op::lui, bits & 0xFFFF'F000U);
    case 0x17:
      return set(Op::auipc, bits & 0xFFFF'F000U);
    case 0x6F:
      return set(Op::jal, immediate_j(bits));
    case 0x67:
      return set(Op::jalr, immediate_i(bits));
    case 0x63:
      return set(kBranches[f3], immediate_b(bits));
    case 0x03:
      return set(kLoads[f3], immediate_i(bits));
    case 0x07:
      return set(Op::flw, immediate_i(bits));
    case 0x23:
      return set(kStores[f3], immediate_s(bits));
    case 0x27:
      return set(Op::fsw, immediate_s(bits));
    case 0x13:
      set(op_immediate(bits), immediate_i(bits));
      if (f3 == 1 || f3 == 5) out.immediate &= 31U;
      return;
    case 0x33:
      return set(op_register(bits));
    case 0x0F:
      return set(f3 == 0 ? Op::fence : Op::fence_i);
    case 0x73:
      return set(system(bits), field(bits, 20, 12));
    case 0x2F:
      return set(atomic(bits));
    case 0x43:
      return set(Op::fmadd);
    case 0x47:
      return set(Op::fmsub);
    case 0x4B:
      return set(Op::fnmsub);
    case 0x4F:
      return set(Op::fnmadd);
    default:
      return set(op_float(bits));
  }
}

}  // namespace

Instruction decode(std::uint32_t bits) {
  Instruction out{};
  out.bytes = static_cast<std::uint8_t>(bytes_of(bits));
  out.bits = out.bytes == 2 ? bits & 0xFFFFU : bits;
  if (!class_of(bits)) {
    out.op = Op::illegal;
    return out;
  }
  if (out.bytes == 2) {
    decode_compressed(out);
    return out;
  }
  out.rd = register_at(bits, 7);
  out.rs1 = register_at(bits, 15);
  out.rs2 = register_at(bits, 20);
  out.rs3 = register_at(bits, 27);
  out.rounding = static_cast<std::uint8_t>(field(bits, 12, 3));
  if (protocol::is_hint(bits)) {
    out.op = Op::hint;
    out.immediate = immediate_i(bits);
    return out;
  }
  decode_full(out);
  return out;
}

bool is_float(Op op) {
  return op == Op::flw || op == Op::fsw || (op >= Op::fmadd && op <= Op::fmv_w_x);
}

bool writes_f(Op op) {
  switch (op) {
    case Op::fsw:
    case Op::fcvt_w_s:
    case Op::fcvt_wu_s:
    case Op::fmv_x_w:
    case Op::feq:
    case Op::flt:
    case Op::fle:
    case Op::fclass:
      return false;
    default:
      return is_float(op);
  }
}

bool writes_x(Op op) {
  if (is_branch(op) || writes_f(op)) return false;
  switch (op) {
    case Op::illegal:
    case Op::sb:
    case Op::sh:
    case Op::sw:
    case Op::fsw:
    case Op::hint:
    case Op::fence:
    case Op::fence_i:
    case Op::ecall:
    case Op::ebreak:
    case Op::mret:
    case Op::wfi:
      return false;
    default:
      return true;
  }
}

bool is_branch(Op op) {
  return op >= Op::beq && op <= Op::bgeu;
}

bool is_access(Op op) {
  return op >= Op::lb && op <= Op::fsw;
}

bool is_store(Op op) {
  return (op >= Op::sb && op <= Op::sw) || op == Op::fsw;
}

std::uint32_t accessed_bytes(Op op) {
  switch (op) {
    case Op::lb:
    case Op::lbu:
    case Op::sb:
      return 1;
    case Op::lh:
    case Op::lhu:
    case Op::sh:
      return 2;
    default:
      return 4;
  }
}

bool is_csr(Op op) {
  return op >= Op::csrrw && op <= Op::csrrci;
}

}  // namespace torolux::translated
