// SPDX-License-Identifier: MIT
// What a PE does, from its processor's side to the emulator: phases, waits and clocks enter, changes of state leave.
// Lies behind the PE's channel where somebody watches; else there is none, and nothing to do but to see that.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "emulator/niu/channel.hpp"
#include "emulator/niu/pe_states.hpp"
#include "emulator/niu/state_tally.hpp"

namespace torolux {

/// A PE is in `state` from `begin` on.
struct StateChange {
  std::uint64_t begin;  ///< [cycles]
  std::uint64_t known;  ///< [cycles] an event at a later time finds it told; see README.md
  PeState state;
};

/// One writer, one reader, in memory that two processes may share. Zeroed memory, its grain set, is an empty one.
class StateLog {
 public:
  static constexpr std::size_t kPlaces = 1024;
  /// Between two HINTs that may wait, no more changes than this are told; the last of them then lasts.
  static constexpr std::uint32_t kMostBetweenHints = 480;

  // ---- The processor's side ----

  void set_grain_shift(std::uint32_t shift) { tally_.set_shift(shift); }
  /// Whether the next HINT may happen: it, and the markers behind it, find places.
  bool has_room() const {
    return written_.load(std::memory_order_relaxed) - read_.load(std::memory_order_acquire) <= kPlaces / 2;
  }
  void hint_ended() { since_hint_ = 0; }
  /// Up to `clock` the PE was busy in its innermost open phase, as it stands in the channel.
  void busy_until(const NiuChannel& channel, std::uint64_t clock) {
    const ProcessorState& state = channel.processor;
    const PeState phase = state.phase_depth != 0 ? state.phases[state.phase_depth - 1] : kOutsidePhases;
    account(clock, phase, state.last_command);
  }
  /// Then it waited, for one reason after the other.
  void waited(const NiuChannel& channel, const WaitCycles& cycles) {
    for (std::size_t reason = 0; reason < kWaitReasons; ++reason) {
      if (cycles[reason] == 0) continue;
      account(tally_.until() + cycles[reason], kFirstWait + reason, channel.processor.last_command);
    }
  }
  /// The run is over at `end`: the PE, which waits or has halted, did nothing from its clock on. By the reader, while
  /// the processor waits.
  void finish(const NiuChannel& channel, std::uint64_t end, PeState last) {
    since_hint_ = 0;
    busy_until(channel, channel.clock.load(std::memory_order_relaxed));
    account(end, last, 0);
    tally_.finish([this](std::uint64_t begin, PeState state) { return put({begin, 0, state}); });
  }

  // ---- The reader ----

  /// take: called with each change that is there, in order. True: there were some.
  template <class Take>
  bool drain(Take take) {
    const std::uint64_t end = written_.load(std::memory_order_acquire);
    std::uint64_t at = read_.load(std::memory_order_relaxed);
    if (at == end) return false;
    for (; at != end; ++at) take(changes_[at % kPlaces]);
    read_.store(at, std::memory_order_release);
    return true;
  }

 private:
  /// last_command: the PE's bound may already be there, though its clock is not.
  void account(std::uint64_t clock, PeState state, std::uint64_t last_command) {
    const std::uint64_t known = clock > last_command ? clock : last_command;
    tally_.account(clock, state, [this, known](std::uint64_t begin, PeState now) { return put({begin, known, now}); });
  }
  bool put(const StateChange& change) {
    if (since_hint_ == kMostBetweenHints) return false;
    ++since_hint_;
    const std::uint64_t at = written_.load(std::memory_order_relaxed);
    changes_[at % kPlaces] = change;
    written_.store(at + 1, std::memory_order_release);
    return true;
  }

  alignas(64) StateTally<kPeStates> tally_;
  std::uint32_t since_hint_;
  alignas(64) std::atomic<std::uint64_t> written_;
  alignas(64) std::atomic<std::uint64_t> read_;
  std::array<StateChange, kPlaces> changes_;
};
static_assert(StateLog::kPlaces >= StateLog::kPlaces / 2 + StateLog::kMostBetweenHints + 16);

/// Of a PE; nullptr where nobody watches.
inline StateLog* state_log_of(NiuChannel& channel) {
  if (channel.state_log == 0) return nullptr;
  return reinterpret_cast<StateLog*>(reinterpret_cast<std::byte*>(&channel) + channel.state_log);
}

}  // namespace torolux
