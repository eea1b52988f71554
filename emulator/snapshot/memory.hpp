// SPDX-License-Identifier: MIT
// A PE's local memory to bytes and back: pages of zeros are named, not written.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include "emulator/snapshot/archive.hpp"
#include "firmware/protocol/machine.hpp"

namespace torolux {

/// memory: whole pages. Where one is zeros on both sides, it is not touched when read.
template <class Archive>
void archive_memory(Archive& archive, std::span<std::byte> memory) {
  constexpr std::size_t kPage = protocol::kPageBytes;
  const auto page = [memory](std::size_t number) { return memory.subspan(number * kPage, kPage); };
  const auto is_zero = [page](std::size_t number) {
    const auto bytes = page(number);
    return bytes[0] == std::byte{0} && std::memcmp(bytes.data(), bytes.data() + 1, bytes.size() - 1) == 0;
  };
  std::vector<bool> filled(memory.size() / kPage);
  if constexpr (!Archive::kReads) {
    for (std::size_t i = 0; i < filled.size(); ++i) filled[i] = !is_zero(i);
  }
  const std::size_t pages = filled.size();
  archive(filled);
  if (filled.size() != pages) refuse_snapshot("the PEs' local memories have another size");
  for (std::size_t i = 0; i < pages; ++i) {
    if (filled[i]) {
      archive.bytes(page(i));
    } else if (!is_zero(i)) {
      std::ranges::fill(page(i), std::byte{0});
    }
  }
}

}  // namespace torolux
