// SPDX-License-Identifier: MIT
// Local memory of a PE whose firmware runs natively: an array that stands for the memory from kLocalMemoryBase on.
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/protocol/machine.hpp"

namespace torolux::pe {

class LocalBase {
 public:
  LocalBase() = default;
  /// memory: aligned to 8, outlives this. stores_begin: address that the image's symbol `__stores_begin` would have.
  LocalBase(std::byte* memory, std::uint32_t stores_begin) : memory_(memory), stores_begin_(stores_begin) {}

  void* pointer(std::uint32_t address) const { return memory_ + (address - protocol::kLocalMemoryBase); }
  std::uint32_t address(const void* pointer) const {
    return protocol::kLocalMemoryBase + static_cast<std::uint32_t>(static_cast<const std::byte*>(pointer) - memory_);
  }
  std::uint32_t stores_begin() const { return stores_begin_; }

 private:
  std::byte* memory_ = nullptr;
  std::uint32_t stores_begin_ = 0;
};

}  // namespace torolux::pe
