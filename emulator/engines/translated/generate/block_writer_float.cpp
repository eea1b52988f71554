// SPDX-License-Identifier: MIT
// The text for each floating-point instruction but loads and stores. Names as in block_writer.cpp.
#include <string>

#include "emulator/engines/translated/generate/block_writer.hpp"

namespace torolux::translated {

/// Operations whose NaN results depend on the host.
bool BlockWriter::write_arithmetic(const Instruction& i) {
  const auto set = [&](const std::string& value) {
    line(assign_f(i.rd, false) + value + ";");
    return true;
  };
  const auto multiply_add = [&](const char* product_sign, const char* sum_sign) {
    return set("fused(" + (product_sign + f(i.rs1)) + ", " + f(i.rs2) + ", " + sum_sign + f(i.rs3) + ")");
  };
  switch (i.op) {
    case Op::fadd:
      return set(f(i.rs1) + " + " + f(i.rs2));
    case Op::fsub:
      return set(f(i.rs1) + " - " + f(i.rs2));
    case Op::fmul:
      return set(f(i.rs1) + " * " + f(i.rs2));
    case Op::fdiv:
      return set(f(i.rs1) + " / " + f(i.rs2));
    case Op::fsqrt:
      return set("square_root(" + f(i.rs1) + ")");
    case Op::fmadd:
      return multiply_add("", "");
    case Op::fmsub:
      return multiply_add("", "-");
    case Op::fnmsub:
      return multiply_add("-", "");
    case Op::fnmadd:
      return multiply_add("-", "-");
    default:
      return false;
  }
}

/// Operations that raise flags, where somebody may look at them.
bool BlockWriter::write_flagged(const Instruction& i) {
  const auto set_f = [&](const std::string& call) {
    line(assign_f(i.rd, true) + "flagged_" + call + ";");
    return true;
  };
  const auto set_x = [&](const std::string& call) {
    line((i.rd == 0 ? std::string() : assign_x(i.rd)) + "flagged_" + call + ";");
    return true;
  };
  const auto two = [&] { return "(pe, " + f(i.rs1) + ", " + f(i.rs2); };
  const auto multiply_add = [&](const char* product_sign, const char* sum_sign) {
    return set_f("fused(pe, " + (product_sign + f(i.rs1)) + ", " + f(i.rs2) + ", " + sum_sign + f(i.rs3) + ")");
  };
  switch (i.op) {
    case Op::fadd:
      return set_f("add" + two() + ")");
    case Op::fsub:
      return set_f("sub" + two() + ")");
    case Op::fmul:
      return set_f("mul" + two() + ")");
    case Op::fdiv:
      return set_f("div" + two() + ")");
    case Op::fsqrt:
      return set_f("sqrt(pe, " + f(i.rs1) + ")");
    case Op::fmadd:
      return multiply_add("", "");
    case Op::fmsub:
      return multiply_add("", "-");
    case Op::fnmsub:
      return multiply_add("-", "");
    case Op::fnmadd:
      return multiply_add("-", "-");
    case Op::fmin:
    case Op::fmax:
      return set_f("extreme" + two() + (i.op == Op::fmax ? ", true)" : ", false)"));
    case Op::fcvt_s_w:
      return set_f("from_signed(pe, " + x(i.rs1) + ")");
    case Op::fcvt_s_wu:
      return set_f("from_unsigned(pe, " + x(i.rs1) + ")");
    case Op::fcvt_w_s:
      return set_x("to_signed(pe, " + f(i.rs1) + ")");
    case Op::fcvt_wu_s:
      return set_x("to_unsigned(pe, " + f(i.rs1) + ")");
    case Op::feq:
      return set_x("equal" + two() + ")");
    case Op::flt:
    case Op::fle:
      return set_x("less" + two() + (i.op == Op::fle ? ", true)" : ", false)"));
    default:
      return false;
  }
}

/// Operations that move or compare, or whose results are never NaN by computation.
bool BlockWriter::write_bits(const Instruction& i) {
  const auto set_f = [&](const std::string& value) {
    line(assign_f(i.rd, true) + value + ";");
    return true;
  };
  const auto set_x = [&](const std::string& value) {
    if (i.rd != 0) line(assign_x(i.rd) + value + ";");
    return true;
  };
  const auto call = [&](const char* name) {
    const std::string first = exact_f(i.rs1);
    return set_f(name + ("(" + first + ", ") + exact_f(i.rs2) + ")");
  };
  switch (i.op) {
    case Op::fsgnj:
      return i.rs1 == i.rs2 ? set_f(exact_f(i.rs1)) : call("with_sign_of");
    case Op::fsgnjn:
      return call("with_other_sign");
    case Op::fsgnjx:
      return call("with_product_sign");
    case Op::fmin:
      return call("smaller");
    case Op::fmax:
      return call("larger");
    case Op::fmv_w_x:
      return set_f("from_bits(" + x(i.rs1) + ")");
    case Op::fcvt_s_w:
      return set_f("static_cast<float>(static_cast<std::int32_t>(" + x(i.rs1) + "))");
    case Op::fcvt_s_wu:
      return set_f("static_cast<float>(" + x(i.rs1) + ")");
    case Op::fmv_x_w:
      return set_x("to_bits(" + exact_f(i.rs1) + ")");
    case Op::feq:
      return set_x(f(i.rs1) + " == " + f(i.rs2) + " ? 1u : 0u");
    case Op::flt:
      return set_x(f(i.rs1) + " < " + f(i.rs2) + " ? 1u : 0u");
    case Op::fle:
      return set_x(f(i.rs1) + " <= " + f(i.rs2) + " ? 1u : 0u");
    case Op::fcvt_w_s:
      return set_x("to_signed(" + f(i.rs1) + ")");
    case Op::fcvt_wu_s:
      return set_x("to_unsigned(" + f(i.rs1) + ")");
    default:
      return false;
  }
}

}  // namespace torolux::translated
