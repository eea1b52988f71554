// SPDX-License-Identifier: MIT
// Runs a program on one PE until it halts, on QEMU, interpreted or translated: everything that can be seen of it
// leaves.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "emulator/engines/engine/engine.hpp"
#include "tests/translated/assembler.hpp"

namespace torolux::test {

enum class Way : std::uint8_t { qemu, interpreted, translated };
std::string name_of(Way way);

/// Where test programs find their data: behind the page of the NIU window, to the end of the smallest local memory.
inline constexpr Word kData = 0x8002'1000U;
inline constexpr Word kDataEnd = 0x8004'0000U;

/// An image of this code, with the NIU window in the page before kData.
Image image_of(const Code& code);

struct Outcome {
  bool halted = false;
  std::string failure;      ///< where it did not
  std::uint64_t clock = 0;  ///< at the end of the halt
  std::uint64_t instructions = 0;
  std::vector<std::byte> memory;  ///< local memory, whole

  std::uint32_t word(Word address) const;
};

using Fill = std::function<void(std::span<std::byte> local_memory)>;

/// fill: changes local memory before the start. The PE's messages are taken and dropped.
Outcome run_to_halt(const Image& image, Way way, const Fill& fill = {});

/// After a trap QEMU's clock is ahead by what stood behind the instruction in its block; ours is exact.
enum class Counts : std::uint8_t { compared, ignored };

/// As above on all three ways; adds failures where anything differs, with the first differing address. label: for the
/// message. Returns QEMU's.
Outcome run_on_all(const Image& image, const std::string& label, const Fill& fill = {},
                   Counts counts = Counts::compared);

}  // namespace torolux::test
