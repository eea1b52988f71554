// SPDX-License-Identifier: MIT
// Encodings picked by hand (assembled by GNU as) have the class that the latency table means.
#include "emulator/engines/isa/instruction_class.hpp"

#include <gtest/gtest.h>

#include "firmware/protocol/hints.hpp"

namespace torolux::test {
namespace {

using Class = InstructionClass;

struct Encoding {
  const char* text;
  std::uint32_t bits;
  std::optional<Class> expected;
};

constexpr Encoding kEncodings[] = {
    {"add a0,a1,a2", 0x00C58533, Class::integer},
    {"sub a0,a1,a2", 0x40C58533, Class::integer},
    {"slli a0,a1,31", 0x01F59513, Class::integer},
    {"srai a0,a1,3", 0x4035D513, Class::integer},
    {"sltiu a0,a1,7", 0x0075B513, Class::integer},
    {"lui a0,0x12345", 0x12345537, Class::integer},
    {"auipc a0,0x1", 0x00001517, Class::integer},
    {"fence", 0x0FF0000F, Class::integer},
    {"fence.i", 0x0000100F, Class::integer},
    {"csrrw a0,mscratch,a1", 0x34059573, Class::integer},
    {"csrrsi zero,fflags,1", 0x0010E073, Class::integer},
    {"ecall", 0x00000073, Class::integer},
    {"ebreak", 0x00100073, Class::integer},
    {"mret", 0x30200073, Class::integer},
    {"wfi", 0x10500073, Class::integer},
    {"beq a0,a1,.", 0x00B50063, Class::branch},
    {"bgeu a0,a1,.", 0x00B57063, Class::branch},
    {"jal ra,.", 0x000000EF, Class::jump},
    {"jalr ra,0(a0)", 0x000500E7, Class::jump},
    {"lb a0,0(a1)", 0x00058503, Class::load},
    {"lhu a0,2(a1)", 0x0025D503, Class::load},
    {"lw a0,4(a1)", 0x0045A503, Class::load},
    {"flw fa0,4(a1)", 0x0045A507, Class::load},
    {"sb a0,0(a1)", 0x00A58023, Class::store},
    {"sw a0,4(a1)", 0x00A5A223, Class::store},
    {"fsw fa0,4(a1)", 0x00A5A227, Class::store},
    {"mul a0,a1,a2", 0x02C58533, Class::multiply},
    {"mulhsu a0,a1,a2", 0x02C5A533, Class::multiply},
    {"div a0,a1,a2", 0x02C5C533, Class::divide},
    {"remu a0,a1,a2", 0x02C5F533, Class::divide},
    {"lr.w a0,(a1)", 0x1005A52F, Class::atomic},
    {"sc.w a0,a2,(a1)", 0x18C5A52F, Class::atomic},
    {"amoadd.w a0,a2,(a1)", 0x00C5A52F, Class::atomic},
    {"amomaxu.w a0,a2,(a1)", 0xE0C5A52F, Class::atomic},
    {"fsgnjx.s fa0,fa1,fa2", 0x20C5A553, Class::float_simple},
    {"fmin.s fa0,fa1,fa2", 0x28C58553, Class::float_simple},
    {"fle.s a0,fa1,fa2", 0xA0C58553, Class::float_simple},
    {"fclass.s a0,fa1", 0xE0059553, Class::float_simple},
    {"fmv.x.w a0,fa1", 0xE0058553, Class::float_simple},
    {"fmv.w.x fa0,a1", 0xF0058553, Class::float_simple},
    {"fadd.s fa0,fa1,fa2", 0x00C5F553, Class::float_add},
    {"fsub.s fa0,fa1,fa2,rtz", 0x08C59553, Class::float_add},
    {"fcvt.w.s a0,fa1", 0xC005F553, Class::float_add},
    {"fcvt.s.wu fa0,a1", 0xD015F553, Class::float_add},
    {"fmul.s fa0,fa1,fa2", 0x10C5F553, Class::float_multiply},
    {"fmadd.s fa0,fa1,fa2,fa3", 0x68C5F543, Class::float_fused},
    {"fnmsub.s fa0,fa1,fa2,fa3", 0x68C5F54B, Class::float_fused},
    {"fdiv.s fa0,fa1,fa2", 0x18C5F553, Class::float_divide},
    {"fsqrt.s fa0,fa1", 0x5805F553, Class::float_sqrt},
    {"slti zero,zero,3", 0x00302013, Class::hint},
    {"slti zero,zero,-1", 0xFFF02013, Class::hint},
    {"slti a0,zero,3", 0x00302513, Class::integer},
    {"c.nop", 0x0001, Class::integer},
    {"c.addi a0,-1", 0x157D, Class::integer},
    {"c.li a0,5", 0x4515, Class::integer},
    {"c.lui a0,0x1f", 0x657D, Class::integer},
    {"c.addi16sp sp,-64", 0x7139, Class::integer},
    {"c.addi4spn a0,sp,16", 0x0808, Class::integer},
    {"c.slli a0,3", 0x050E, Class::integer},
    {"c.srli a0,3", 0x810D, Class::integer},
    {"c.srai a0,3", 0x850D, Class::integer},
    {"c.andi a0,3", 0x890D, Class::integer},
    {"c.sub a0,a1", 0x8D0D, Class::integer},
    {"c.xor a0,a1", 0x8D2D, Class::integer},
    {"c.or a0,a1", 0x8D4D, Class::integer},
    {"c.and a0,a1", 0x8D6D, Class::integer},
    {"c.mv a0,a1", 0x852E, Class::integer},
    {"c.add a0,a1", 0x952E, Class::integer},
    {"c.ebreak", 0x9002, Class::integer},
    {"c.j .", 0xA001, Class::jump},
    {"c.jal .", 0x2001, Class::jump},
    {"c.jr a0", 0x8502, Class::jump},
    {"c.jalr a0", 0x9502, Class::jump},
    {"c.beqz a0,.", 0xC101, Class::branch},
    {"c.bnez a0,.", 0xE101, Class::branch},
    {"c.lw a0,4(a1)", 0x41C8, Class::load},
    {"c.lwsp a0,4(sp)", 0x4512, Class::load},
    {"c.flw fa0,4(a1)", 0x61C8, Class::load},
    {"c.flwsp fa0,4(sp)", 0x6512, Class::load},
    {"c.sw a0,4(a1)", 0xC1C8, Class::store},
    {"c.swsp a0,4(sp)", 0xC22A, Class::store},
    {"c.fsw fa0,4(a1)", 0xE1C8, Class::store},
    {"c.fswsp fa0,4(sp)", 0xE22A, Class::store},
    {"fld fa0,0(a1)", 0x0005B507, std::nullopt},
    {"fsd fa0,0(a1)", 0x00A5B027, std::nullopt},
    {"fadd.d fa0,fa1,fa2", 0x02C5F553, std::nullopt},
    {"fcvt.d.s fa0,fa1", 0x42058553, std::nullopt},
    {"fmadd.d fa0,fa1,fa2,fa3", 0x6AC5F543, std::nullopt},
    {"c.fld fa0,0(a1)", 0x2188, std::nullopt},
    {"c.fsdsp fa0,0(sp)", 0xA02A, std::nullopt},
    {"sret", 0x10200073, std::nullopt},
    {"sh1add a0,a1,a2", 0x20C5A533, std::nullopt},
    {"all zeros", 0x0, std::nullopt},
    {"all ones", 0xFFFFFFFF, std::nullopt},
    {"fadd.s with a reserved rounding mode", 0x00C5D553, std::nullopt},
    {"slli by 32", 0x02059513, std::nullopt},
};

TEST(InstructionClass, IsThatOfTheManual) {
  for (const Encoding& encoding : kEncodings) {
    const auto found = class_of(encoding.bits);
    EXPECT_EQ(found.has_value(), encoding.expected.has_value()) << encoding.text;
    if (found && encoding.expected) {
      EXPECT_EQ(name_of(*found), name_of(*encoding.expected)) << encoding.text;
    }
  }
}

TEST(InstructionClass, OfACompressedInstructionIgnoresWhatFollows) {
  for (const Encoding& encoding : kEncodings) {
    if (bytes_of(encoding.bits) == 2) {
      EXPECT_EQ(class_of(encoding.bits | 0xABCD'0000U), encoding.expected) << encoding.text;
    }
  }
}

TEST(InstructionClass, EveryClassOccursAbove) {
  std::array<bool, kInstructionClasses> seen{};
  for (const Encoding& encoding : kEncodings) {
    if (encoding.expected) seen[static_cast<std::size_t>(*encoding.expected)] = true;
  }
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_TRUE(seen[i]) << name_of(static_cast<Class>(i));
  }
}

TEST(InstructionClass, CyclesComeFromTheTableAndMarkersAreFree) {
  LatencyTable latency{};
  for (std::size_t i = 0; i < latency.size(); ++i) latency[i] = static_cast<std::uint32_t>(100 + i);
  EXPECT_EQ(cycles_of(0x02C58533, latency), 100 + static_cast<std::uint32_t>(Class::multiply)) << "mul a0,a1,a2";
  EXPECT_EQ(cycles_of(protocol::hint_instruction(3), latency), 100 + static_cast<std::uint32_t>(Class::hint));
  EXPECT_EQ(cycles_of(0, latency), 100U) << "what traps costs as an integer instruction";
  const auto marker = static_cast<std::int32_t>(protocol::Hint::enter_phase);
  EXPECT_TRUE(is_phase_marker(protocol::hint_instruction(marker)));
  EXPECT_EQ(cycles_of(protocol::hint_instruction(marker), latency), 0U);
  EXPECT_EQ(cycles_of(protocol::hint_instruction(marker + 64 + 15), latency), 0U);
  EXPECT_FALSE(is_phase_marker(protocol::hint_instruction(marker + 16)));
  EXPECT_FALSE(is_phase_marker(protocol::hint_instruction(marker - 1)));
  EXPECT_FALSE(is_phase_marker(protocol::hint_instruction(marker) | 0x80U)) << "rd = x1";
}

}  // namespace
}  // namespace torolux::test
