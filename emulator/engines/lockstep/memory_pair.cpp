// SPDX-License-Identifier: MIT
// fstat tells cheaply whether pages have been added; lseek finds them.
#include "emulator/engines/lockstep/memory_pair.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

namespace torolux::lockstep {
namespace {

constexpr std::uint32_t kPage = 4096;

std::uint64_t allocated(const SharedMemory& memory) {
  struct stat status {};
  return fstat(memory.descriptor(), &status) == 0 ? static_cast<std::uint64_t>(status.st_blocks) : 0;
}

}  // namespace

MemoryPair::MemoryPair(const SharedMemory& first, const SharedMemory& second, std::uint32_t bytes)
    : first_(first), second_(second), bytes_(bytes) {}

void MemoryPair::mark_touched(const SharedMemory& memory, std::vector<bool>& pages) const {
  off_t at = lseek(memory.descriptor(), 0, SEEK_DATA);
  while (at >= 0 && at < static_cast<off_t>(bytes_)) {
    const off_t end = std::min<off_t>(lseek(memory.descriptor(), at, SEEK_HOLE), static_cast<off_t>(bytes_));
    for (off_t page = at / kPage; page * kPage < end; ++page) pages[static_cast<std::size_t>(page)] = true;
    at = lseek(memory.descriptor(), end, SEEK_DATA);
  }
}

std::span<const MemoryRange> MemoryPair::touched() {
  const std::uint64_t now = allocated(first_) + allocated(second_);
  if (now == allocated_) return ranges_;
  allocated_ = now;
  std::vector<bool> pages((bytes_ + kPage - 1) / kPage);
  mark_touched(first_, pages);
  mark_touched(second_, pages);
  ranges_.clear();
  for (std::uint32_t page = 0; page < pages.size(); ++page) {
    if (!pages[page]) continue;
    const std::uint32_t begin = page * kPage;
    if (ranges_.empty() || ranges_.back().end != begin) ranges_.push_back({begin, begin});
    ranges_.back().end = std::min(begin + kPage, bytes_);
  }
  return ranges_;
}

std::optional<std::uint32_t> MemoryPair::first_difference() {
  const std::byte* first = first_.bytes().data();
  const std::byte* second = second_.bytes().data();
  for (const MemoryRange& range : touched()) {
    if (std::memcmp(first + range.begin, second + range.begin, range.end - range.begin) == 0) continue;
    const auto [left, right] = std::mismatch(first + range.begin, first + range.end, second + range.begin);
    return static_cast<std::uint32_t>(left - first);
  }
  return std::nullopt;
}

}  // namespace torolux::lockstep
