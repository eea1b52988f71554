// SPDX-License-Identifier: MIT
// What engine and plugin share for one PE, in memory that both map: settings on the way in, counters on the way out.
#pragma once

#include <atomic>
#include <cstdint>

#include "emulator/description/description.hpp"
#include "emulator/engines/engine/registers.hpp"

namespace torolux {

inline constexpr std::uint32_t kPluginShareVersion = 5;

enum class HintLogUse : std::uint32_t { none, record, replay };

struct PluginShare {
  // Set by the engine before QEMU starts.
  std::uint32_t version;             ///< kPluginShareVersion
  std::uint32_t window_offset;       ///< of the NIU window in local memory
  std::uint32_t local_memory_bytes;  ///< the PE's
  std::int32_t channel_descriptor;   ///< NiuChannel, open in QEMU's process
  std::int32_t local_descriptor;     ///< local memory, likewise
  std::int32_t log_descriptor;       ///< see hint_log.hpp; only where it is used
  HintLogUse log_use;
  std::int32_t meeting_descriptor;  ///< HintMeeting; -1: the plugin itself does what HINTs do
  /// 1: count instruction by instruction. A debugger's watchpoint leaves a block in the middle, and begins again there.
  std::uint32_t counts_instructions;
  std::uint64_t channel_layout;  ///< niu_channel_layout()
  LatencyTable latency;
  /// 1: the PE does not begin at `_start`, but repeats a HINT, which it met at this clock and count.
  std::uint32_t resumes;
  std::uint64_t resumed_clock, resumed_instructions;

  // Counted by the plugin at the start of each block, so ahead of the PE by up to a block; or see above.
  alignas(64) std::uint64_t cycles;  ///< of all instructions since `_start`, the NIU driver's retries included
  std::uint64_t instructions;
  std::atomic<std::uint32_t> stack_wanted;  ///< 1, by the engine: tell `stack` at the next block, wherever that is

  // Set by the plugin.
  std::atomic<std::uint32_t> stack_known;  ///< 1: `stack` is where the PE stands, or has ended; 2: it cannot be told
  StackRegisters stack;
  std::atomic<std::uint64_t> retry_clock;         ///< of the HINT that the PE repeats, at its first execution
  std::atomic<std::uint64_t> retry_instructions;  ///< likewise
  std::atomic<std::uint64_t> cycles_at_hint;      ///< `cycles` at the end of the last HINT
  std::atomic<std::uint64_t> hints;               ///< so far, retries included: shows that the plugin is alive
  std::atomic<std::uint32_t> stopped;             ///< 1: the process ended because the machine or the PE had ended
  std::atomic<std::uint32_t> diverged;            ///< 1: a replayed PE did not do what it had done when it was recorded
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free && std::atomic<std::uint32_t>::is_always_lock_free);

}  // namespace torolux
