// SPDX-License-Identifier: MIT
// Mnemonics of Op in its order, and their operands by kind. Rounding modes are left out.
#include "emulator/engines/lockstep/disassembly.hpp"

#include <array>
#include <sstream>
#include <string_view>

namespace torolux::lockstep {
namespace {

using translated::Instruction;
using translated::Op;

constexpr std::array<std::string_view, static_cast<std::size_t>(Op::csrrci) + 1> kNames = {
    "(illegal)", "lui",      "auipc",     "addi",      "slti",      "sltiu",     "xori",     "ori",      "andi",
    "slli",      "srli",     "srai",      "add",       "sub",       "sll",       "slt",      "sltu",     "xor",
    "srl",       "sra",      "or",        "and",       "mul",       "mulh",      "mulhsu",   "mulhu",    "div",
    "divu",      "rem",      "remu",      "jal",       "jalr",      "beq",       "bne",      "blt",      "bge",
    "bltu",      "bgeu",     "lb",        "lh",        "lw",        "lbu",       "lhu",      "sb",       "sh",
    "sw",        "flw",      "fsw",       "lr.w",      "sc.w",      "amoswap.w", "amoadd.w", "amoxor.w", "amoand.w",
    "amoor.w",   "amomin.w", "amomax.w",  "amominu.w", "amomaxu.w", "fmadd.s",   "fmsub.s",  "fnmsub.s", "fnmadd.s",
    "fadd.s",    "fsub.s",   "fmul.s",    "fdiv.s",    "fsqrt.s",   "fsgnj.s",   "fsgnjn.s", "fsgnjx.s", "fmin.s",
    "fmax.s",    "fcvt.w.s", "fcvt.wu.s", "fmv.x.w",   "feq.s",     "flt.s",     "fle.s",    "fclass.s", "fcvt.s.w",
    "fcvt.s.wu", "fmv.w.x",  "hint",      "fence",     "fence.i",   "ecall",     "ebreak",   "mret",     "wfi",
    "csrrw",     "csrrs",    "csrrc",     "csrrwi",    "csrrsi",    "csrrci"};
static_assert(kNames.back() == "csrrci");

constexpr std::array<std::string_view, 32> kX = {"zero", "ra", "sp", "gp", "tp",  "t0",  "t1", "t2", "s0", "s1", "a0",
                                                 "a1",   "a2", "a3", "a4", "a5",  "a6",  "a7", "s2", "s3", "s4", "s5",
                                                 "s6",   "s7", "s8", "s9", "s10", "s11", "t3", "t4", "t5", "t6"};
constexpr std::array<std::string_view, 32> kF = {
    "ft0", "ft1", "ft2", "ft3", "ft4", "ft5", "ft6", "ft7", "fs0", "fs1", "fa0",  "fa1",  "fa2", "fa3", "fa4",  "fa5",
    "fa6", "fa7", "fs2", "fs3", "fs4", "fs5", "fs6", "fs7", "fs8", "fs9", "fs10", "fs11", "ft8", "ft9", "ft10", "ft11"};

bool is_between(Op op, Op first, Op last) {
  return op >= first && op <= last;
}

/// Whether rs1 of a floating-point operation is an x register.
bool reads_x(Op op) {
  return op == Op::fcvt_s_w || op == Op::fcvt_s_wu || op == Op::fmv_w_x;
}
bool has_two_operands(Op op) {
  return is_between(op, Op::fadd, Op::fdiv) || is_between(op, Op::fsgnj, Op::fmax) || is_between(op, Op::feq, Op::fle);
}

std::string hexadecimal(std::uint32_t value) {
  std::ostringstream text;
  text << "0x" << std::hex << value;
  return text.str();
}
std::string decimal(std::uint32_t immediate) {
  return std::to_string(static_cast<std::int32_t>(immediate));
}
std::string list(std::initializer_list<std::string_view> operands) {
  std::string text;
  for (const std::string_view operand : operands) text.append(text.empty() ? " " : ", ").append(operand);
  return text;
}

std::string operands_of_float(const Instruction& i) {
  const std::string_view to = translated::writes_f(i.op) ? kF[i.rd] : kX[i.rd];
  if (is_between(i.op, Op::fmadd, Op::fnmadd)) return list({to, kF[i.rs1], kF[i.rs2], kF[i.rs3]});
  if (has_two_operands(i.op)) return list({to, kF[i.rs1], kF[i.rs2]});
  return list({to, reads_x(i.op) ? kX[i.rs1] : kF[i.rs1]});
}

std::string operands_of(const Instruction& i, std::uint32_t pc) {
  const std::string place = decimal(i.immediate) + "(" + std::string(kX[i.rs1]) + ")";
  if (i.op == Op::lui || i.op == Op::auipc) return list({kX[i.rd], hexadecimal(i.immediate >> 12U)});
  if (is_between(i.op, Op::addi, Op::srai)) return list({kX[i.rd], kX[i.rs1], decimal(i.immediate)});
  if (is_between(i.op, Op::add, Op::remu)) return list({kX[i.rd], kX[i.rs1], kX[i.rs2]});
  if (i.op == Op::jal) return list({kX[i.rd], hexadecimal(pc + i.immediate)});
  if (i.op == Op::jalr) return list({kX[i.rd], place});
  if (translated::is_branch(i.op)) return list({kX[i.rs1], kX[i.rs2], hexadecimal(pc + i.immediate)});
  if (i.op == Op::flw) return list({kF[i.rd], place});
  if (i.op == Op::fsw) return list({kF[i.rs2], place});
  if (is_between(i.op, Op::lb, Op::lhu)) return list({kX[i.rd], place});
  if (is_between(i.op, Op::sb, Op::sw)) return list({kX[i.rs2], place});
  if (i.op == Op::lr) return list({kX[i.rd], "(" + std::string(kX[i.rs1]) + ")"});
  if (is_between(i.op, Op::sc, Op::amomaxu)) {
    return list({kX[i.rd], kX[i.rs2], "(" + std::string(kX[i.rs1]) + ")"});
  }
  if (is_between(i.op, Op::fmadd, Op::fmv_w_x)) return operands_of_float(i);
  if (i.op == Op::hint) return list({decimal(i.immediate)});
  if (is_between(i.op, Op::csrrw, Op::csrrc)) return list({kX[i.rd], hexadecimal(i.immediate), kX[i.rs1]});
  if (translated::is_csr(i.op)) return list({kX[i.rd], hexadecimal(i.immediate), std::to_string(i.rs1)});
  return "";
}

}  // namespace

std::string disassemble(const Instruction& instruction, std::uint32_t pc) {
  return std::string(kNames[static_cast<std::size_t>(instruction.op)]) + operands_of(instruction, pc);
}

}  // namespace torolux::lockstep
