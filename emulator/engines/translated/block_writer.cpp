// SPDX-License-Identifier: MIT
// The text for each instruction. Names in it: x1..x31, f0..f31, memory, load_limit, store_limit, at, count, pe, and the
// labels of region_writer's frame.
#include "emulator/engines/translated/block_writer.hpp"

#include <string_view>

namespace torolux::translated {
namespace {

std::string decimal(std::int64_t value) {
  return std::to_string(value);
}

/// "$1 + $2" with operands put in.
std::string fill(std::string_view pattern, const std::string& first, const std::string& second = {}) {
  std::string text;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (pattern[i] != '$') {
      text += pattern[i];
      continue;
    }
    text += pattern[++i] == '1' ? first : second;
  }
  return text;
}

std::string_view pattern_of_two(Op op) {
  switch (op) {
    case Op::addi:
    case Op::add:
      return "$1 + $2";
    case Op::sub:
      return "$1 - $2";
    case Op::slti:
    case Op::slt:
      return "less_signed($1, $2)";
    case Op::sltiu:
    case Op::sltu:
      return "$1 < $2 ? 1u : 0u";
    case Op::xori:
    case Op::xor_:
      return "$1 ^ $2";
    case Op::ori:
    case Op::or_:
      return "$1 | $2";
    case Op::andi:
    case Op::and_:
      return "$1 & $2";
    case Op::slli:
    case Op::sll:
      return "$1 << ($2 & 31u)";
    case Op::srli:
    case Op::srl:
      return "$1 >> ($2 & 31u)";
    case Op::srai:
    case Op::sra:
      return "shift_right_arithmetic($1, $2)";
    case Op::mul:
      return "$1 * $2";
    case Op::mulh:
      return "mulh($1, $2)";
    case Op::mulhsu:
      return "mulhsu($1, $2)";
    case Op::mulhu:
      return "mulhu($1, $2)";
    case Op::div:
      return "div($1, $2)";
    case Op::divu:
      return "divu($1, $2)";
    case Op::rem:
      return "rem($1, $2)";
    case Op::remu:
      return "remu($1, $2)";
    default:
      return {};
  }
}

std::string_view type_of_load(Op op) {
  switch (op) {
    case Op::lb:
      return "std::int8_t";
    case Op::lbu:
      return "std::uint8_t";
    case Op::lh:
      return "std::int16_t";
    case Op::lhu:
      return "std::uint16_t";
    default:
      return "std::uint32_t";
  }
}

}  // namespace

std::string hexadecimal(std::uint32_t value) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "0x";
  for (unsigned shift = 32; shift != 0; shift -= 4) text += kDigits[(value >> (shift - 4)) & 15U];
  return text + "u";
}

void BlockWriter::line(const std::string& text) {
  out_ += "  ";
  out_ += text;
  out_ += '\n';
}

std::string BlockWriter::x(unsigned n) {
  if (n == 0) return "0u";
  use_.x.set(n);
  return "x" + decimal(n);
}

std::string BlockWriter::assign_x(unsigned n) {
  use_.x.set(n);
  use_.x_written.set(n);
  return "x" + decimal(n) + " = ";
}

std::string BlockWriter::f(unsigned n) {
  use_.f.set(n);
  return "f" + decimal(n);
}

std::string BlockWriter::exact_f(unsigned n) {
  if (unsettled_.test(n)) line(f(n) + " = canonical(" + f(n) + ");");
  unsettled_.reset(n);
  return f(n);
}

std::string BlockWriter::assign_f(unsigned n, bool settled) {
  use_.f_written.set(n);
  unsettled_.set(n, !settled);
  return f(n) + " = ";
}

void BlockWriter::settle() {
  for (unsigned n = 0; n < 32; ++n) exact_f(n);
}

/// To the interpreter; what it sees must be exact.
std::string BlockWriter::look(std::uint32_t pc) const {
  std::string text = "{ ";
  for (unsigned n = 0; n < 32; ++n) {
    if (unsettled_.test(n)) text += "f" + decimal(n) + " = canonical(f" + decimal(n) + "); ";
  }
  return text + "at = " + hexadecimal(pc) + "; goto look; }";
}

std::string BlockWriter::address(const Instruction& i, std::uint32_t base) {
  return x(i.rs1) + " + " + hexadecimal(i.immediate - base);
}

void BlockWriter::write_load(const Instruction& i, std::uint32_t pc) {
  const std::string value = "load_at<" + std::string(type_of_load(i.op)) + ">(memory, o)";
  line("{ const std::uint32_t o = " + address(i, kMemoryBase) + ";");
  line("  if (TOROLUX_RARELY(o >= load_limit)) " + look(pc));
  if (i.op == Op::flw) {
    line("  " + assign_f(i.rd, true) + "load_at<float>(memory, o); }");
  } else if (i.rd == 0) {
    line("}");
  } else {
    line("  " + assign_x(i.rd) + "static_cast<std::uint32_t>(" + value + "); }");
  }
}

void BlockWriter::write_store(const Instruction& i, std::uint32_t pc) {
  const std::string value = i.op == Op::fsw  ? exact_f(i.rs2)
                            : i.op == Op::sb ? "static_cast<std::uint8_t>(" + x(i.rs2) + ")"
                            : i.op == Op::sh ? "static_cast<std::uint16_t>(" + x(i.rs2) + ")"
                                             : x(i.rs2);
  line("{ const std::uint32_t o = " + address(i, code_.store_base()) + ";");
  line("  if (TOROLUX_RARELY(o >= store_limit)) " + look(pc));
  line("  store_at(stores, o, " + value + "); }");
}

bool BlockWriter::write_memory(const Instruction& i, std::uint32_t pc) {
  if (i.op < Op::lb || i.op > Op::fsw) return false;
  const bool stores = (i.op >= Op::sb && i.op <= Op::sw) || i.op == Op::fsw;
  if (stores) {
    write_store(i, pc);
  } else {
    write_load(i, pc);
  }
  return true;
}

bool BlockWriter::write_integer(const Instruction& i, std::uint32_t pc) {
  if (i.op == Op::fence || i.op == Op::fence_i) return true;
  if (i.op == Op::lui || i.op == Op::auipc) {
    const std::uint32_t value = i.op == Op::lui ? i.immediate : pc + i.immediate;
    if (i.rd != 0) line(assign_x(i.rd) + hexadecimal(value) + ";");
    return true;
  }
  const std::string_view pattern = pattern_of_two(i.op);
  if (pattern.empty()) return false;
  const bool has_immediate = i.op <= Op::srai;
  const std::string second = has_immediate ? hexadecimal(i.immediate) : x(i.rs2);
  const std::string text = fill(pattern, x(i.rs1), second);
  if (i.rd != 0) line(assign_x(i.rd) + text + ";");
  return true;
}

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

void BlockWriter::write_marker(const Instruction& i, std::uint32_t pc, Cost cost_behind) {
  const std::string behind = decimal(static_cast<std::int64_t>(pack(cost_behind))) + "ull";
  line("if (TOROLUX_RARELY(!mark(pe, count - " + behind + ", " + decimal(static_cast<std::int32_t>(i.immediate)) +
       "))) " + look(pc));
}

void BlockWriter::write(const Instruction& i, std::uint32_t pc, Cost cost_behind) {
  if (i.op == Op::hint) {
    write_marker(i, pc, cost_behind);
    return;
  }
  static_cast<void>(write_integer(i, pc) || write_memory(i, pc) || (observed_ && write_flagged(i)) ||
                    write_arithmetic(i) || write_bits(i));
  if (observed_ && writes_f(i.op)) line("pe->mstatus |= 0x6000u;");
}

std::string BlockWriter::condition(const Instruction& i) {
  const std::string a = x(i.rs1);
  const std::string b = x(i.rs2);
  const auto signed_of = [](const std::string& value) { return "static_cast<std::int32_t>(" + value + ")"; };
  switch (i.op) {
    case Op::beq:
      return a + " == " + b;
    case Op::bne:
      return a + " != " + b;
    case Op::blt:
      return signed_of(a) + " < " + signed_of(b);
    case Op::bge:
      return signed_of(a) + " >= " + signed_of(b);
    case Op::bltu:
      return a + " < " + b;
    default:
      return a + " >= " + b;
  }
}

}  // namespace torolux::translated
