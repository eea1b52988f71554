// SPDX-License-Identifier: MIT
// Proves: mnemonics and operands are those of binutils' objdump (-M no-aliases), for one instruction of each form.
#include "emulator/engines/lockstep/disassembly.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace torolux::lockstep {
namespace {

TEST(Disassembly, EveryFormOfInstruction) {
  constexpr std::uint32_t kPc = 0x8000'0100;
  const std::pair<std::uint32_t, const char*> cases[] = {{0x12345537, "lui a0, 0x12345"},
                                                         {0x00001597, "auipc a1, 0x1"},
                                                         {0xffc58513, "addi a0, a1, -4"},
                                                         {0x40365593, "srai a1, a2, 3"},
                                                         {0x40c58533, "sub a0, a1, a2"},
                                                         {0x02c5f533, "remu a0, a1, a2"},
                                                         {0x008000ef, "jal ra, 0x80000108"},
                                                         {0x00008067, "jalr zero, 0(ra)"},
                                                         {0xfeb51ce3, "bne a0, a1, 0x800000f8"},
                                                         {0xffc12503, "lw a0, -4(sp)"},
                                                         {0x00a41123, "sh a0, 2(s0)"},
                                                         {0x0045a507, "flw fa0, 4(a1)"},
                                                         {0x00a5a427, "fsw fa0, 8(a1)"},
                                                         {0x1005a52f, "lr.w a0, (a1)"},
                                                         {0x18c5a52f, "sc.w a0, a2, (a1)"},
                                                         {0xe0c5a52f, "amomaxu.w a0, a2, (a1)"},
                                                         {0x68c5f543, "fmadd.s fa0, fa1, fa2, fa3"},
                                                         {0x18c5f553, "fdiv.s fa0, fa1, fa2"},
                                                         {0x5805f553, "fsqrt.s fa0, fa1"},
                                                         {0xa0c59553, "flt.s a0, fa1, fa2"},
                                                         {0xc0059553, "fcvt.w.s a0, fa1"},
                                                         {0xd005f553, "fcvt.s.w fa0, a1"},
                                                         {0xf0058553, "fmv.w.x fa0, a1"},
                                                         {0x00302013, "hint 3"},
                                                         {0x30200073, "mret"},
                                                         {0x30559573, "csrrw a0, 0x305, a1"},
                                                         {0x0012d573, "csrrwi a0, 0x1, 5"},
                                                         {0x0000852e, "add a0, zero, a1"},  // c.mv
                                                         {0x00004512, "lw a0, 4(sp)"},      // c.lwsp
                                                         {0x00000000, "(illegal)"}};
  for (const auto& [bits, text] : cases) EXPECT_EQ(disassemble(translated::decode(bits), kPc), text);
}

}  // namespace
}  // namespace torolux::lockstep
