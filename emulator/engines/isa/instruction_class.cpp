// SPDX-License-Identifier: MIT
// Decodes RV32IMAFC as far as the class of an instruction goes.
#include "emulator/engines/isa/instruction_class.hpp"

#include "firmware/protocol/hints.hpp"

namespace torolux {
namespace {

using Class = InstructionClass;
using Decoded = std::optional<InstructionClass>;

constexpr std::uint32_t field(std::uint32_t instruction, unsigned low, unsigned bits) {
  return (instruction >> low) & ((1U << bits) - 1U);
}
constexpr std::uint32_t funct3(std::uint32_t instruction) {
  return field(instruction, 12, 3);
}
constexpr std::uint32_t funct7(std::uint32_t instruction) {
  return field(instruction, 25, 7);
}
constexpr std::uint32_t rs2(std::uint32_t instruction) {
  return field(instruction, 20, 5);
}

Decoded if_valid(bool valid, Class instruction_class) {
  return valid ? Decoded(instruction_class) : std::nullopt;
}

Decoded op_immediate(std::uint32_t instruction) {
  switch (funct3(instruction)) {
    case 1:
      return if_valid(funct7(instruction) == 0, Class::integer);
    case 5:
      return if_valid((funct7(instruction) & ~0x20U) == 0, Class::integer);
    default:
      return Class::integer;
  }
}

Decoded op(std::uint32_t instruction) {
  const std::uint32_t f3 = funct3(instruction);
  switch (funct7(instruction)) {
    case 0x00:
      return Class::integer;
    case 0x20:
      return if_valid(f3 == 0 || f3 == 5, Class::integer);
    case 0x01:
      return f3 < 4 ? Class::multiply : Class::divide;
    default:
      return std::nullopt;
  }
}

Decoded atomic(std::uint32_t instruction) {
  if (funct3(instruction) != 2) {
    return std::nullopt;
  }
  switch (field(instruction, 27, 5)) {
    case 0x02:  // lr.w
      return if_valid(rs2(instruction) == 0, Class::atomic);
    case 0x03:  // sc.w
    case 0x01:
    case 0x00:
    case 0x04:
    case 0x0C:
    case 0x08:
    case 0x10:
    case 0x14:
    case 0x18:
    case 0x1C:
      return Class::atomic;
    default:
      return std::nullopt;
  }
}

/// Rounding modes 5 and 6 are reserved.
bool rounds(std::uint32_t instruction) {
  return funct3(instruction) != 5 && funct3(instruction) != 6;
}

Decoded op_float(std::uint32_t instruction) {
  const std::uint32_t f3 = funct3(instruction);
  switch (funct7(instruction)) {  // the lowest two bits are the format: single only
    case 0x00:                    // fadd.s
    case 0x04:                    // fsub.s
      return if_valid(rounds(instruction), Class::float_add);
    case 0x08:
      return if_valid(rounds(instruction), Class::float_multiply);
    case 0x0C:
      return if_valid(rounds(instruction), Class::float_divide);
    case 0x2C:
      return if_valid(rounds(instruction) && rs2(instruction) == 0, Class::float_sqrt);
    case 0x10:  // fsgnj, fsgnjn, fsgnjx
    case 0x50:  // fle, flt, feq
      return if_valid(f3 < 3, Class::float_simple);
    case 0x14:  // fmin, fmax
      return if_valid(f3 < 2, Class::float_simple);
    case 0x60:  // fcvt.w.s, fcvt.wu.s
    case 0x68:  // fcvt.s.w, fcvt.s.wu
      return if_valid(rounds(instruction) && rs2(instruction) < 2, Class::float_add);
    case 0x70:  // fmv.x.w, fclass
      return if_valid(f3 < 2 && rs2(instruction) == 0, Class::float_simple);
    case 0x78:  // fmv.w.x
      return if_valid(f3 == 0 && rs2(instruction) == 0, Class::float_simple);
    default:
      return std::nullopt;
  }
}

Decoded system(std::uint32_t instruction) {
  if (funct3(instruction) == 4) {
    return std::nullopt;
  }
  if (funct3(instruction) != 0) {
    return Class::integer;  // csr*
  }
  constexpr std::uint32_t kEcall = 0x0000'0073, kEbreak = 0x0010'0073, kMret = 0x3020'0073, kWfi = 0x1050'0073;
  const bool known = instruction == kEcall || instruction == kEbreak || instruction == kMret || instruction == kWfi;
  return if_valid(known, Class::integer);
}

Decoded full(std::uint32_t instruction) {
  const std::uint32_t f3 = funct3(instruction);
  switch (instruction & 0x7FU) {
    case 0x37:  // lui
    case 0x17:  // auipc
      return Class::integer;
    case 0x6F:
      return Class::jump;
    case 0x67:
      return if_valid(f3 == 0, Class::jump);
    case 0x63:
      return if_valid(f3 != 2 && f3 != 3, Class::branch);
    case 0x03:
      return if_valid(f3 != 3 && f3 < 6, Class::load);
    case 0x07:
      return if_valid(f3 == 2, Class::load);
    case 0x23:
      return if_valid(f3 < 3, Class::store);
    case 0x27:
      return if_valid(f3 == 2, Class::store);
    case 0x13:
      return op_immediate(instruction);
    case 0x33:
      return op(instruction);
    case 0x0F:
      return if_valid(f3 < 2, Class::integer);
    case 0x73:
      return system(instruction);
    case 0x2F:
      return atomic(instruction);
    case 0x43:  // fmadd, fmsub, fnmsub, fnmadd
    case 0x47:
    case 0x4B:
    case 0x4F:
      return if_valid(field(instruction, 25, 2) == 0 && rounds(instruction), Class::float_fused);
    case 0x53:
      return op_float(instruction);
    default:
      return std::nullopt;
  }
}

Decoded compressed_quadrant_1(std::uint32_t instruction) {
  const bool immediate_is_zero = (instruction & 0x107CU) == 0;
  switch (field(instruction, 13, 3)) {
    case 0:  // c.addi, c.nop
    case 2:  // c.li
      return Class::integer;
    case 1:  // c.jal
    case 5:  // c.j
      return Class::jump;
    case 3:  // c.lui, c.addi16sp
      return if_valid(!immediate_is_zero, Class::integer);
    case 4:
      break;
    default:  // c.beqz, c.bnez
      return Class::branch;
  }
  const bool bit_12 = field(instruction, 12, 1) != 0;
  switch (field(instruction, 10, 2)) {
    case 0:  // c.srli
    case 1:  // c.srai: shifts by 32 and more are not of RV32
    case 3:  // c.sub, c.xor, c.or, c.and; with bit 12 set they are of RV64
      return if_valid(!bit_12, Class::integer);
    default:  // c.andi
      return Class::integer;
  }
}

Decoded compressed_quadrant_2(std::uint32_t instruction) {
  const std::uint32_t rd = field(instruction, 7, 5);
  const bool bit_12 = field(instruction, 12, 1) != 0;
  switch (field(instruction, 13, 3)) {
    case 0:  // c.slli
      return if_valid(!bit_12, Class::integer);
    case 2:  // c.lwsp
      return if_valid(rd != 0, Class::load);
    case 3:  // c.flwsp
      return Class::load;
    case 4:
      break;
    case 6:  // c.swsp
    case 7:  // c.fswsp
      return Class::store;
    default:  // double precision
      return std::nullopt;
  }
  if (field(instruction, 2, 5) != 0) {
    return Class::integer;  // c.mv, c.add
  }
  if (rd == 0) {
    return if_valid(bit_12, Class::integer);  // c.ebreak
  }
  return Class::jump;  // c.jr, c.jalr
}

Decoded compressed(std::uint32_t instruction) {
  switch (instruction & 3U) {
    case 0:
      break;
    case 1:
      return compressed_quadrant_1(instruction);
    default:
      return compressed_quadrant_2(instruction);
  }
  switch (field(instruction, 13, 3)) {
    case 0:  // c.addi4spn; all zeros is illegal by intent
      return if_valid(field(instruction, 5, 8) != 0, Class::integer);
    case 2:  // c.lw
    case 3:  // c.flw
      return Class::load;
    case 6:  // c.sw
    case 7:  // c.fsw
      return Class::store;
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<InstructionClass> class_of(std::uint32_t instruction) {
  if (bytes_of(instruction) == 2) {
    return compressed(instruction & 0xFFFFU);
  }
  return protocol::is_hint(instruction) ? Class::hint : full(instruction);
}

bool is_phase_marker(std::uint32_t instruction) {
  return protocol::is_hint(instruction) && protocol::is_phase_marker(protocol::hint_immediate(instruction));
}

std::uint32_t cycles_of(std::uint32_t instruction, const LatencyTable& latency) {
  if (is_phase_marker(instruction)) {
    return 0;
  }
  return latency[static_cast<std::size_t>(class_of(instruction).value_or(Class::integer))];
}

}  // namespace torolux
