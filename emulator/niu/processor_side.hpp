// SPDX-License-Identifier: MIT
// The processor's side of a NIU: what an engine calls at every HINT. Enters: operation and clock; leaves: what the
// HINT did to local memory and to the clock. Runs in the engine's thread or process, beside the emulator's scheduler.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace torolux {

/// Shared by both sides of a NIU; lies in memory that engine and emulator both map. See channel.hpp.
struct NiuChannel;

/// Bytes of a channel, and the channel that lies (zeroed or in use) at `memory`, aligned to 4096.
std::size_t niu_channel_bytes();
/// The same with rings of kLeastRingBytes, which the channel's `ring_bytes` must say.
std::size_t small_niu_channel_bytes();
NiuChannel* niu_channel_at(void* memory);
/// Differs between builds whose channels are laid out differently: both sides must be from one build.
std::uint64_t niu_channel_layout();

class NiuProcessorSide {
 public:
  /// What a HINT does whose answer is not known yet.
  enum class Waiting : std::uint8_t {
    sleeps,   ///< on the channel, at most some 50 ms; then it answers `retry`
    returns,  ///< answers `retry` at once; the ProcessorWaker tells when to call `hint` again
  };

  /// window_offset: of `__niu_window` in local memory.
  NiuProcessorSide(NiuChannel& channel, std::span<std::byte> local_memory, std::uint32_t window_offset,
                   Waiting waiting = Waiting::sleeps);

  enum class Outcome : std::uint8_t {
    done,   ///< the HINT has happened; the PE's clock is now `clock`
    retry,  ///< not yet: window.retry is set, execute the HINT again at the same clock
    stop,   ///< the machine ends, or this PE has halted: execute nothing more
  };
  struct Result {
    Outcome outcome;
    std::uint64_t clock;
  };

  /// clock: the PE's at the HINT, its own cost included. instructions: executed so far, likewise exact.
  Result hint(std::int32_t immediate, std::uint64_t clock, std::uint64_t instructions);

 private:
  Result mark(std::int32_t immediate, std::uint64_t clock);
  /// Any but a marker that nests as it should.
  Result happen(std::int32_t immediate, std::uint64_t clock);

  NiuChannel& channel_;
  std::span<std::byte> local_memory_;
  std::uint32_t window_offset_;
  Waiting waiting_;
};

}  // namespace torolux
