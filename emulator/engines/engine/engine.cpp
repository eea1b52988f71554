// SPDX-License-Identifier: MIT
// How much memory an engine needs behind a PE's own.
#include "emulator/engines/engine/engine.hpp"

#include <algorithm>

namespace torolux {

std::size_t mapped_bytes_for(std::uint32_t local_memory_bytes) {
  // QEMU puts 1 MiB of device tree into RAM, 2 MiB-aligned, as far up as it goes: the RAM is made so large that this
  // lies beyond local memory. It does not start with less than 4 MiB.
  constexpr std::size_t kAlignment = 2U << 20U;
  constexpr std::size_t kLeast = 4U << 20U;
  const std::size_t rounded = (local_memory_bytes + kAlignment - 1) / kAlignment * kAlignment;
  return std::max(rounded + kAlignment, kLeast);
}

}  // namespace torolux
