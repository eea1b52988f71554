// SPDX-License-Identifier: MIT
// What the plugin's callbacks must know of an instruction: made when its block is translated, asked when it is
// executed.
#pragma once

#include <cstdint>

#include "emulator/engines/qemu/counters.hpp"

namespace torolux {

/// What a HINT's callback must know about the rest of its block, which the block's start has counted already.
/// Packed into the callback's pointer, so that translating allocates nothing. A block has at most 512 instructions.
struct HintPlace {
  std::int32_t immediate;           // 12 bits
  std::uint32_t instructions_left;  // 12 bits
  std::uint32_t cycles_left;        // 32 bits

  void* pack() const {
    const std::uint64_t bits = (static_cast<std::uint64_t>(cycles_left) << 24U) | (instructions_left << 12U) |
                               (static_cast<std::uint32_t>(immediate) & 0xFFFU);
    return reinterpret_cast<void*>(bits);  // NOLINT(performance-no-int-to-ptr): never followed
  }
  static HintPlace unpack(const void* pointer) {
    const auto bits = reinterpret_cast<std::uint64_t>(pointer);
    return {static_cast<std::int32_t>(static_cast<std::uint32_t>(bits) << 20U) >> 20,
            static_cast<std::uint32_t>(bits >> 12U) & 0xFFFU, static_cast<std::uint32_t>(bits >> 24U)};
  }
};

/// An instruction that is counted alone, packed likewise.
struct CountedPlace {
  std::uint32_t address;
  std::uint32_t cycles;  // 24 bits
  bool is_marker;        // costs nothing, and is not counted
  bool may_repeat;       // accesses memory: a watchpoint makes QEMU begin it once more

  void* pack() const {
    const std::uint64_t bits = (static_cast<std::uint64_t>(address) << 32U) | ((cycles & kMostCycles) << 8U) |
                               (is_marker ? 2U : 0U) | (may_repeat ? 1U : 0U);
    return reinterpret_cast<void*>(bits);  // NOLINT(performance-no-int-to-ptr): never followed
  }
  static CountedPlace unpack(const void* pointer) {
    const auto bits = reinterpret_cast<std::uint64_t>(pointer);
    return {static_cast<std::uint32_t>(bits >> 32U), static_cast<std::uint32_t>(bits >> 8U) & kMostCycles,
            (bits & 2U) != 0, (bits & 1U) != 0};
  }
  static constexpr std::uint32_t kMostCycles = 0xFF'FFFFU;
};

/// A block, counted as a whole where it begins.
struct BlockPlace {
  std::uint32_t address;
  std::uint32_t instructions;
  std::uint64_t cycles;
};

/// A `wfi` that the program may come to: what stands behind it in its block, and its address.
struct WaitPlace {
  HintPlace rest;
  std::uint32_t address;
};

/// The reading of a counter, likewise; QEMU gives the computer's, so the register is set once more behind it.
struct CounterPlace {
  HintPlace rest;
  CounterRead read;
  std::uint32_t next;  // address of the following instruction, where a block begins
};

}  // namespace torolux
