// SPDX-License-Identifier: MIT
// Two local memories that should be equal. Enters: both, while nobody writes; leaves: the first difference. Memory that
// nobody has ever touched is zero on both sides, and is not read: the kernel knows which pages that is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "emulator/engines/engine/shared_memory.hpp"

namespace torolux::lockstep {

/// Bytes [begin, end) of local memory.
struct MemoryRange {
  std::uint32_t begin, end;
};

class MemoryPair {
 public:
  /// Both Use::shared, at least `bytes` long; only so much is looked at. They outlive this.
  MemoryPair(const SharedMemory& first, const SharedMemory& second, std::uint32_t bytes);

  /// Whole pages that somebody has touched on either side; ascending.
  std::span<const MemoryRange> touched();
  /// Offset of the first byte that differs.
  std::optional<std::uint32_t> first_difference();

 private:
  void mark_touched(const SharedMemory& memory, std::vector<bool>& pages) const;

  const SharedMemory& first_;
  const SharedMemory& second_;
  std::uint32_t bytes_;
  std::uint64_t allocated_ = 0;  // of both, when ranges_ was made
  std::vector<MemoryRange> ranges_;
};

}  // namespace torolux::lockstep
