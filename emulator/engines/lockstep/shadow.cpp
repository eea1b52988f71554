// SPDX-License-Identifier: MIT
// Now and then the whole PE is kept; in between, only what HINTs wrote. To go back is to go there, and run again.
#include "emulator/engines/lockstep/shadow.hpp"

#include <cstring>

#include "emulator/engines/engine/engine.hpp"
#include "emulator/engines/qemu/hint_effects.hpp"

namespace torolux::lockstep {
namespace {

/// HINTs between two copies of the whole PE: a copy costs about as much as the comparison at one HINT.
constexpr std::size_t kMostEffects = 64;
constexpr std::uint64_t kNoLimit = ~std::uint64_t{0};

void copy(std::span<const MemoryRange> ranges, std::span<const std::byte> from, std::span<std::byte> to) {
  for (const MemoryRange& range : ranges) {
    std::memcpy(&to[range.begin], &from[range.begin], range.end - range.begin);
  }
}

}  // namespace

Shadow::Shadow(const translated::TranslatedImage& code, const SharedMemory& original, std::uint32_t local_memory_bytes,
               NiuProcessorSide& markers)
    : code_(code),
      told_(&markers),
      memory_("torolux-shadow", local_memory_bytes),
      memories_(original, memory_, local_memory_bytes),
      kept_memory_("torolux-kept", local_memory_bytes, SharedMemory::Use::here) {
  copy(memories_.touched(), original.bytes(), memory_.bytes());
  code_.start(pe_, memory_.bytes(), mapped_bytes_for(local_memory_bytes));
  pe_.marker = &Shadow::marker;
  pe_.context = this;
  keep();
}

void Shadow::marker(void* shadow, std::int32_t immediate, std::uint64_t clock, std::uint64_t instructions) {
  auto& self = *static_cast<Shadow*>(shadow);
  self.trail_.add({clock, instructions, immediate, 0});
  // A marker that is wrong stops the NIU: the next HINT says so.
  if (self.told_ != nullptr) self.told_->hint(immediate, clock, instructions);
}

translated::TranslatedImage::Stop Shadow::run(std::uint64_t cycle_limit) {
  pe_.cycle_limit = cycle_limit;
  return code_.run(pe_);
}

void Shadow::keep() {
  kept_pe_ = pe_;
  copy(memories_.touched(), memory_.bytes(), kept_memory_.bytes());
  effects_.clear();
  patches_.clear();
  patched_.clear();
}

void Shadow::follow(std::span<const std::byte> original, std::uint32_t window_offset, std::uint64_t clock) {
  for_each_written(pe_.hint_immediate, original, window_offset, [&](std::uint32_t offset, std::uint32_t bytes) {
    const std::byte* from = original.data() + offset;
    std::memcpy(&memory_.bytes()[offset], from, bytes);
    patches_.push_back({offset, bytes});
    patched_.insert(patched_.end(), from, from + bytes);
  });
  pe_.cycles = clock;
  effects_.push_back({clock, patches_.size()});
  if (effects_.size() == kMostEffects) keep();
}

void Shadow::go_back() {
  told_ = nullptr;
  pe_ = kept_pe_;
  copy(memories_.touched(), kept_memory_.bytes(), memory_.bytes());
  std::size_t patch = 0;
  const std::byte* bytes = patched_.data();
  for (const Effect& effect : effects_) {
    run(kNoLimit);  // it got to the HINT before
    for (; patch < effect.patches_end; ++patch) {
      std::memcpy(&memory_.bytes()[patches_[patch].offset], bytes, patches_[patch].bytes);
      bytes += patches_[patch].bytes;
    }
    pe_.cycles = effect.clock;
  }
}

}  // namespace torolux::lockstep
