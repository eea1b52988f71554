// SPDX-License-Identifier: MIT
// The text for each instruction. Names in it: x1..x31, f0..f31, memory, load_limit, store_limit, count, pe.
#include "emulator/engines/translated/generate/block_writer.hpp"

#include <string_view>

#include "emulator/hexadecimal.hpp"

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
  return torolux::hexadecimal(value) + "u";
}

void BlockWriter::line(const std::string& text) {
  out_ += "  ";
  out_ += text;
  out_ += '\n';
}

std::string BlockWriter::x(unsigned n) {
  return n == 0 ? "0u" : "x" + decimal(n);
}

std::string BlockWriter::assign_x(unsigned n) {
  return "x" + decimal(n) + " = ";
}

std::string BlockWriter::f(unsigned n) {
  return "f" + decimal(n);
}

std::string BlockWriter::exact_f(unsigned n) {
  if ((raw_ & f_register(n)) != 0) line(f(n) + " = canonical(" + f(n) + ");");
  raw_ &= ~f_register(n);
  return f(n);
}

void BlockWriter::canonicalize(RegisterSet registers) {
  for (unsigned n = 0; n < 32; ++n) {
    if ((registers & f_register(n)) != 0) static_cast<void>(exact_f(n));
  }
}

std::string BlockWriter::assign_f(unsigned n, bool canonical) {
  raw_ = canonical ? raw_ & ~f_register(n) : raw_ | f_register(n);
  return f(n) + " = ";
}

std::string BlockWriter::save(RegisterSet registers) const {
  std::string text;
  for (unsigned n = 1; n < 32; ++n) {
    if ((registers & x_register(n)) != 0) text += "pe->x[" + decimal(n) + "] = " + x(n) + "; ";
  }
  for (unsigned n = 0; n < 32; ++n) {
    if ((registers & f_register(n)) == 0) continue;
    const std::string value = (raw_ & f_register(n)) != 0 ? "canonical(" + f(n) + ")" : f(n);
    text += "pe->f[" + decimal(n) + "] = to_bits(" + value + "); ";
  }
  return text;
}

std::string BlockWriter::load(RegisterSet registers) {
  std::string text;
  for (unsigned n = 1; n < 32; ++n) {
    if ((registers & x_register(n)) != 0) text += assign_x(n) + "pe->x[" + decimal(n) + "]; ";
  }
  for (unsigned n = 0; n < 32; ++n) {
    if ((registers & f_register(n)) != 0) text += f(n) + " = from_bits(pe->f[" + decimal(n) + "]); ";
  }
  return text;
}

std::string BlockWriter::leave(RegisterSet registers, const std::string& at) const {
  return "{ " + save(registers) + "return {count, " + at + "}; }";
}

/// To the interpreter.
std::string BlockWriter::look(std::uint32_t pc, RegisterSet registers) const {
  return leave(registers, "left_for(Exit::look, " + hexadecimal(pc) + ")");
}

void BlockWriter::begin(RegisterSet raw, const AccessChecks& checks) {
  raw_ = raw;
  checks_ = checks;
}

bool BlockWriter::may_look(std::uint32_t pc) const {
  return checks_.contains(pc) || code_.at(pc)->instruction.op == Op::hint;
}

/// Before an access, where needed: whether it and later ones are plainly allowed.
void BlockWriter::write_check(const Instruction& i, std::uint32_t pc, RegisterSet look_saves) {
  const auto found = checks_.find(pc);
  if (found == checks_.end()) return;
  const auto& [stores, offsets] = found->second;
  const std::uint32_t begin = stores ? code_.store_base() : kMemoryBase;
  const std::string first = x(i.rs1) + " + " + hexadecimal(static_cast<std::uint32_t>(offsets.lowest) - begin);
  const std::string last = offsets.highest == offsets.lowest
                               ? first
                               : "std::uint64_t{" + first + "} + " + decimal(offsets.highest - offsets.lowest) + "u";
  line("if (TOROLUX_RARELY(" + last + " >= " + (stores ? "store_limit" : "load_limit") + ")) " + look(pc, look_saves));
}

bool BlockWriter::write_memory(const Instruction& i, std::uint32_t pc, RegisterSet look_saves) {
  if (!is_access(i.op)) return false;
  if (i.op == Op::fsw) exact_f(i.rs2);
  write_check(i, pc, look_saves);
  const std::string at = "memory, " + x(i.rs1) + ", " + decimal(static_cast<std::int32_t>(i.immediate));
  if (is_store(i.op)) {
    const std::string value = i.op == Op::fsw  ? f(i.rs2)
                              : i.op == Op::sb ? "static_cast<std::uint8_t>(" + x(i.rs2) + ")"
                              : i.op == Op::sh ? "static_cast<std::uint16_t>(" + x(i.rs2) + ")"
                                               : x(i.rs2);
    line("store_at(" + at + ", " + value + ");");
  } else if (i.op == Op::flw) {
    line(assign_f(i.rd, true) + "load_at<float>(" + at + ");");
  } else if (i.rd != 0) {
    line(assign_x(i.rd) + "static_cast<std::uint32_t>(load_at<" + std::string(type_of_load(i.op)) + ">(" + at + "));");
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

void BlockWriter::write_marker(const Instruction& i, std::uint32_t pc, Cost cost_behind, RegisterSet look_saves) {
  const std::string behind = decimal(static_cast<std::int64_t>(pack(cost_behind))) + "ull";
  line("if (TOROLUX_RARELY(!mark(pe, count - " + behind + ", " + decimal(static_cast<std::int32_t>(i.immediate)) +
       "))) " + look(pc, look_saves));
}

void BlockWriter::write(const Instruction& i, std::uint32_t pc, Cost cost_behind, RegisterSet look_saves) {
  if (i.op == Op::hint) {
    write_marker(i, pc, cost_behind, look_saves);
    return;
  }
  static_cast<void>(write_integer(i, pc) || write_memory(i, pc, look_saves) || (observed_ && write_flagged(i)) ||
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
