// SPDX-License-Identifier: MIT
// One PE of the translated engine: runs its code from HINT to HINT and takes each to its NIU. Enters: the shared
// translation, local memory and channel; leaves: what stopped it. One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "emulator/cache_line.hpp"
#include "emulator/engines/engine/engine.hpp"
#include "emulator/engines/translated/run/translated_image.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/niu/processor_side.hpp"
#include "emulator/profile/pe_profile.hpp"

namespace torolux::translated {

/// Until when the scheduler's thread runs a PE instead of waiting.
class Goal {
 public:
  virtual ~Goal() = default;
  /// Asked after each HINT.
  virtual bool reached() const = 0;
};

class Processor {
 public:
  /// All outlive this. number: of the PE.
  Processor(const TranslatedImage& code, const EngineSetup& setup, unsigned number);
  Processor(const Processor&) = delete;
  Processor& operator=(const Processor&) = delete;

  enum class Stop : std::uint8_t {
    waits,     ///< for the network: go on when the waker has been called
    enough,    ///< what the scheduler waits for has come
    slice,     ///< it has run long enough; others have their turn
    finished,  ///< it has halted or can never go on, or the machine has stopped
  };
  /// Runs until one of these; goal: none.
  Stop run(const Goal* goal);
  /// For a debugger: one instruction, interpreted, and the HINT that it is, if it is one. Stop::slice: it has happened.
  Stop step();
  const TranslatedImage& code() const { return code_; }
  const TranslatedPe& state() const { return pe_; }
  /// Between two steps, in no HINT.
  TranslatedPe& state() { return pe_; }
  bool waits_in_hint() const { return at_hint_ == AtHint::waits || at_hint_ == AtHint::reached; }
  bool has_ended() const { return at_hint_ == AtHint::finished || fault_.has_value(); }
  /// What it begins with, into the caches.
  void fetch_ahead() const {
    const auto* const bytes = reinterpret_cast<const std::byte*>(this);
    for (std::size_t at = 0; at < kBeginsWith; at += kCacheLine) __builtin_prefetch(bytes + at, 1);
  }
  /// While nobody runs it, and it waits or has finished without a fault.
  PeRegisters save() const;
  /// While nobody runs it.
  StackRegisters stack_registers() const;
  /// Before its first run.
  void restore(const PeRegisters& registers);
  /// To be looked at by others: its bound, and what it waits for.
  const NiuChannel& channel() const { return channel_; }
  /// It runs by `step` alone.
  void take_turns() { channel_.takes_turns = 1; }

 private:
  static constexpr std::size_t kBeginsWith = 512;  // all but control and status registers

  /// Where a HINT stands at which the code has stopped.
  enum class AtHint : std::uint8_t {
    none,      ///< there is none: it has happened, and the PE may go on
    reached,   ///< nobody has asked the NIU yet
    waits,     ///< the NIU has no answer yet
    finished,  ///< the PE executes nothing more
  };
  AtHint ask(std::int32_t immediate, std::uint64_t clock, std::uint64_t instructions);
  bool loops() const;
  TranslatedImage::Stop execute();
  WaitCycles waits() const;
  Stop give_up(const NiuFault& fault);
  Stop give_up_stuck();
  Stop give_up_waiting();
  Stop end();
  static void marker(void* processor, std::int32_t immediate, std::uint64_t clock, std::uint64_t instructions);
  static bool hint(void* processor, std::int32_t immediate, std::uint64_t clock, std::uint64_t instructions);

  const TranslatedImage& code_;
  NiuChannel& channel_;
  NiuProcessorSide niu_;
  AtHint at_hint_ = AtHint::none;
  profile::PeProfile* profile_;  // null: none
  bool asked_ = false;           // by the code itself, at the HINT at which it has stopped
  const Goal* goal_ = nullptr;
  std::optional<NiuFault> fault_;  // why it executes nothing more
  TranslatedPe pe_{};
};

}  // namespace torolux::translated
