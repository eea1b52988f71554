// SPDX-License-Identifier: MIT
// Where QEMU's plugin and the emulator meet at every HINT of a PE in lock step: QEMU stops there, the emulator does
// what the HINT does, and lets it go on. Lies in memory that both map, one for each PE.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace torolux {

struct PassedMarker {
  std::uint64_t clock;
  std::uint64_t instructions;
  std::int32_t immediate;
  std::uint32_t unused;

  bool operator==(const PassedMarker&) const = default;
};

/// All phase markers that a PE has passed: their number, a hash of them, and the last ones. Zeroed memory has none.
struct MarkerTrail {
  static constexpr std::size_t kKept = 64;

  std::uint64_t count;
  std::uint64_t hash;
  std::array<PassedMarker, kKept> last;  ///< number n at n % kKept

  void add(const PassedMarker& marker) {
    last[count % kKept] = marker;
    ++count;
    for (const std::uint64_t value : {marker.clock, marker.instructions, std::uint64_t(marker.immediate)}) {
      hash = (hash ^ value) * 0x9E37'79B9'7F4A'7C15U;
      hash ^= hash >> 29U;
    }
  }
};

struct HintMeeting {
  enum Turn : std::uint32_t { of_qemu, of_emulator };

  std::atomic<std::uint32_t> turn;  ///< a futex; zeroed memory: of_qemu

  // Set by the plugin before it is the emulator's turn.
  std::int32_t immediate;
  std::uint64_t instructions;  ///< so far
  MarkerTrail markers;         ///< so far

  std::uint64_t clock;  ///< at the HINT; the emulator sets it to the clock at the HINT's end
  std::uint32_t stop;   ///< set by the emulator: execute nothing more
};

}  // namespace torolux
