// SPDX-License-Identifier: MIT
// A PE of the translated engine with its own local memory, which follows one that runs elsewhere. Enters: what HINTs
// did to the other; leaves: this one, at its next HINT, or as it was after the last.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "emulator/engines/lockstep/memory_pair.hpp"
#include "emulator/engines/qemu/hint_meeting.hpp"
#include "emulator/engines/translated/run/translated_image.hpp"
#include "emulator/niu/processor_side.hpp"

namespace torolux::lockstep {

class Shadow {
 public:
  /// Copies `original`, in which nothing has run yet. markers: is told of phase markers. All outlive this.
  Shadow(const translated::TranslatedImage& code, const SharedMemory& original, std::uint32_t local_memory_bytes,
         NiuProcessorSide& markers);
  Shadow(const Shadow&) = delete;
  Shadow& operator=(const Shadow&) = delete;

  /// Runs to the next HINT that is no phase marker; cycle_limit: gives up there.
  translated::TranslatedImage::Stop run(std::uint64_t cycle_limit);
  /// The HINT has happened elsewhere: takes what it wrote there, and the clock at its end.
  void follow(std::span<const std::byte> original, std::uint32_t window_offset, std::uint64_t clock);
  /// Back to where the last HINT had just happened. Nothing more is to be run or followed after that.
  void go_back();

  translated::TranslatedPe& pe() { return pe_; }
  const MarkerTrail& markers() const { return trail_; }
  /// Local memory, and the original.
  MemoryPair& memories() { return memories_; }
  std::span<std::byte> memory() const { return memory_.bytes().first(pe_.memory_bytes); }

 private:
  void keep();
  static void marker(void* shadow, std::int32_t immediate, std::uint64_t clock, std::uint64_t instructions);

  /// What a HINT did, since the PE was kept.
  struct Effect {
    std::uint64_t clock;
    std::size_t patches_end;
  };
  struct Patch {
    std::uint32_t offset, bytes;
  };

  const translated::TranslatedImage& code_;
  NiuProcessorSide* told_;
  SharedMemory memory_;
  MemoryPair memories_;
  translated::TranslatedPe pe_{};
  MarkerTrail trail_{};

  translated::TranslatedPe kept_pe_{};
  SharedMemory kept_memory_;
  std::vector<Effect> effects_;
  std::vector<Patch> patches_;
  std::vector<std::byte> patched_;  // their bytes, one after another
};

}  // namespace torolux::lockstep
