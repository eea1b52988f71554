// SPDX-License-Identifier: MIT
// Reading `cycle`, `time`, `instret` and their like on QEMU. Enters: an instruction, or a register and its value;
// leaves: which counter it reads, or QEMU's register changed.
#pragma once

#include <cstdint>
#include <optional>

namespace torolux {

/// An instruction that reads a counter and writes none.
struct CounterRead {
  enum class Of : std::uint8_t { clock, instructions };
  Of of;
  bool high;             ///< of the 64 bits
  unsigned destination;  ///< the number of an x register

  std::uint32_t value(std::uint64_t clock, std::uint64_t instructions) const {
    const std::uint64_t whole = of == Of::clock ? clock : instructions;
    return static_cast<std::uint32_t>(high ? whole >> 32U : whole);
  }
};
inline constexpr std::uint32_t kCounterReadBytes = 4;

/// RISC-V unprivileged architecture, Zicsr and Zicntr; privileged architecture, mcycle and minstret.
std::optional<CounterRead> counter_read(std::uint32_t instruction);

/// Of the one processor, from a callback at the start of a block: then QEMU has all registers in memory. False: this
/// QEMU does not export what is needed, which is no part of its plugin interface.
bool set_register(unsigned number, std::uint32_t value);

}  // namespace torolux
