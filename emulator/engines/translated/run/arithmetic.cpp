// SPDX-License-Identifier: MIT
// Integer and floating-point arithmetic of the interpreter.
#include "emulator/engines/translated/run/arithmetic.hpp"

#include "emulator/engines/translated/run/control.hpp"
#include "emulator/engines/translated/semantics/integer.hpp"
#include "emulator/engines/translated/semantics/soft_float.hpp"

namespace torolux::translated {
namespace {

using soft::Rounding;

std::uint32_t with_immediate(const Instruction& i, std::uint32_t pc, std::uint32_t a) {
  switch (i.op) {
    case Op::lui:
      return i.immediate;
    case Op::auipc:
      return pc + i.immediate;
    case Op::addi:
      return a + i.immediate;
    case Op::slti:
      return less_signed(a, i.immediate);
    case Op::sltiu:
      return a < i.immediate ? 1 : 0;
    case Op::xori:
      return a ^ i.immediate;
    case Op::ori:
      return a | i.immediate;
    case Op::andi:
      return a & i.immediate;
    case Op::slli:
      return a << i.immediate;
    case Op::srli:
      return a >> i.immediate;
    default:
      return shift_right_arithmetic(a, i.immediate);
  }
}

std::uint32_t of_two(Op op, std::uint32_t a, std::uint32_t b) {
  switch (op) {
    case Op::add:
      return a + b;
    case Op::sub:
      return a - b;
    case Op::sll:
      return a << (b & 31U);
    case Op::slt:
      return less_signed(a, b);
    case Op::sltu:
      return a < b ? 1 : 0;
    case Op::xor_:
      return a ^ b;
    case Op::srl:
      return a >> (b & 31U);
    case Op::sra:
      return shift_right_arithmetic(a, b);
    case Op::or_:
      return a | b;
    case Op::and_:
      return a & b;
    case Op::mul:
      return a * b;
    case Op::mulh:
      return mulh(a, b);
    case Op::mulhsu:
      return mulhsu(a, b);
    case Op::mulhu:
      return mulhu(a, b);
    case Op::div:
      return div(a, b);
    case Op::divu:
      return divu(a, b);
    case Op::rem:
      return rem(a, b);
    default:
      return remu(a, b);
  }
}

/// Operations that do not round.
bool compute_plain(TranslatedPe& pe, const Instruction& i) {
  const std::uint32_t a = pe.f[i.rs1];
  const std::uint32_t b = pe.f[i.rs2];
  std::uint32_t& f = pe.f[i.rd];
  std::uint32_t& x = pe.x[i.rd];
  switch (i.op) {
    case Op::fsgnj:
      f = (a & ~soft::kSign) | (b & soft::kSign);
      return true;
    case Op::fsgnjn:
      f = (a & ~soft::kSign) | (~b & soft::kSign);
      return true;
    case Op::fsgnjx:
      f = a ^ (b & soft::kSign);
      return true;
    case Op::fmin:
    case Op::fmax:
      f = soft::min_or_max(a, b, i.op == Op::fmax, pe.fflags);
      return true;
    case Op::fmv_w_x:
      f = pe.x[i.rs1];
      return true;
    case Op::fmv_x_w:
      x = a;
      return true;
    case Op::feq:
      x = soft::equal(a, b, pe.fflags);
      return true;
    case Op::flt:
    case Op::fle:
      x = soft::less(a, b, i.op == Op::fle, pe.fflags);
      return true;
    case Op::fclass:
      x = soft::classify(a);
      return true;
    default:
      return false;
  }
}

void compute_rounded(TranslatedPe& pe, const Instruction& i, Rounding mode) {
  const std::uint32_t a = pe.f[i.rs1];
  const std::uint32_t b = pe.f[i.rs2];
  const std::uint32_t c = pe.f[i.rs3];
  std::uint32_t& flags = pe.fflags;
  const auto negated = [](std::uint32_t value) { return soft::is_nan(value) ? value : value ^ soft::kSign; };
  switch (i.op) {
    case Op::fadd:
      pe.f[i.rd] = soft::add(a, b, mode, flags);
      break;
    case Op::fsub:
      pe.f[i.rd] = soft::sub(a, b, mode, flags);
      break;
    case Op::fmul:
      pe.f[i.rd] = soft::mul(a, b, mode, flags);
      break;
    case Op::fdiv:
      pe.f[i.rd] = soft::div(a, b, mode, flags);
      break;
    case Op::fsqrt:
      pe.f[i.rd] = soft::sqrt(a, mode, flags);
      break;
    case Op::fmadd:
      pe.f[i.rd] = soft::fused(a, b, c, mode, flags);
      break;
    case Op::fmsub:
      pe.f[i.rd] = soft::fused(a, b, negated(c), mode, flags);
      break;
    case Op::fnmsub:
      pe.f[i.rd] = soft::fused(negated(a), b, c, mode, flags);
      break;
    case Op::fnmadd:
      pe.f[i.rd] = soft::fused(negated(a), b, negated(c), mode, flags);
      break;
    case Op::fcvt_w_s:
      pe.x[i.rd] = soft::to_signed(a, mode, flags);
      break;
    case Op::fcvt_wu_s:
      pe.x[i.rd] = soft::to_unsigned(a, mode, flags);
      break;
    case Op::fcvt_s_w:
      pe.f[i.rd] = soft::from_signed(pe.x[i.rs1], mode, flags);
      break;
    default:
      pe.f[i.rd] = soft::from_unsigned(pe.x[i.rs1], mode, flags);
      break;
  }
}

}  // namespace

bool compute_integer(TranslatedPe& pe, const Instruction& i) {
  if (i.op <= Op::srai) {
    pe.x[i.rd] = with_immediate(i, pe.pc, pe.x[i.rs1]);
  } else if (i.op <= Op::remu) {
    pe.x[i.rd] = of_two(i.op, pe.x[i.rs1], pe.x[i.rs2]);
  }
  return true;
}

bool compute_float(TranslatedPe& pe, const Instruction& i) {
  if (!compute_plain(pe, i)) {
    const std::uint32_t mode = i.rounding == kDynamic ? pe.frm : i.rounding;
    if (mode > static_cast<std::uint32_t>(Rounding::nearest_away)) return false;
    compute_rounded(pe, i, static_cast<Rounding>(mode));
  }
  if (writes_f(i.op)) mark_float_dirty(pe);
  return true;
}

}  // namespace torolux::translated
