// SPDX-License-Identifier: MIT
// A PE's processor while it waits in a HINT, or has halted: the same on every engine, so that one may go on where
// another has stopped.
#pragma once

#include <array>
#include <cstdint>

namespace torolux {

inline constexpr unsigned kProtectedRegions = 16;

/// PeRegisters::halted of a PE that a debugger holds: it is in no HINT, and pc is that of the next instruction.
inline constexpr std::uint32_t kStandsBetween = 2;

/// All that a program can see. No padding: it is saved as it is.
struct PeRegisters {
  std::uint64_t clock;         ///< [cycles] at the HINT, its own cost included, what it waits for not
  std::uint64_t instructions;  ///< executed so far, the HINT included
  std::array<std::uint32_t, 32> x;
  std::array<std::uint32_t, 32> f;  ///< bits of binary32
  std::uint32_t pc;                 ///< behind the HINT
  std::int32_t hint_immediate;      ///< of the HINT, which has not happened yet
  std::uint32_t halted;             ///< 1: it has happened, and nothing follows; kStandsBetween: see there
  std::uint32_t fflags, frm;
  std::uint32_t mstatus, mstatush, mtvec, mscratch, mepc, mcause, mtval, mie, mip;
  std::array<std::uint32_t, kProtectedRegions> pmpaddr;
  std::array<std::uint8_t, kProtectedRegions> pmpcfg;
  std::uint32_t reserved_address, reserved_value;  ///< of lr.w; address 0xFFFF'FFFF: none
};
static_assert(sizeof(PeRegisters) == 16 + 4 * (64 + 14 + 16 + 2) + 16);

/// What the calls that led to where a PE stands are found by. Registers that a call need not keep may be wrong.
struct StackRegisters {
  std::uint32_t pc;  ///< of the instruction, or of the HINT, at which it stands
  std::array<std::uint32_t, 32> x;
};

/// Those that calls keep, and the way back: ra, sp, s0 to s11. Of x1 to x31, as bits.
inline constexpr std::uint32_t kStackRegisters = 1U << 1U | 1U << 2U | 3U << 8U | 0x3FFU << 18U;

}  // namespace torolux
