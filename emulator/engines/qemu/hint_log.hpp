// SPDX-License-Identifier: MIT
// What every HINT of a run did to a PE's local memory and clock: recorded beside the NIU, and replayed instead of it.
// The replayed PE executes the same instructions, with no network, no emulator and no waiting: the measure of QEMU
// alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "emulator/niu/processor_side.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {

/// Lies at the beginning of the log's memory; the entries follow.
struct HintLogHead {
  std::uint64_t used;    ///< bytes of entries
  std::uint64_t cycles;  ///< clock at the last entry
  std::uint64_t instructions;
  std::uint32_t whole;     ///< 1: everything so far; 0: the log was full at some time
  std::uint32_t replayed;  ///< 1: a replay has come to the end
};

/// One HINT that is no phase marker, or (immediate 0) the state at the start.
struct HintLogEntry {
  std::uint64_t clock;  ///< at the HINT's end
  std::int32_t immediate;
  std::uint32_t patches;  ///< that follow
};

/// Bytes of local memory that the HINT wrote; the bytes follow, padded to a multiple of 8.
struct HintLogPatch {
  std::uint32_t offset;  ///< in local memory
  std::uint32_t bytes;
};

class HintRecorder {
 public:
  /// Begins with the NIU window as it is.
  HintRecorder(std::span<std::byte> log, std::span<const std::byte> local_memory, std::uint32_t window_offset);
  /// After each HINT that has happened. Nothing more is recorded once the log is full.
  void happened(std::int32_t immediate, std::uint64_t clock, std::uint64_t instructions);

 private:
  void patch(std::uint32_t offset, std::uint32_t bytes, std::uint32_t& patches);
  std::byte* take(std::size_t bytes);

  std::span<std::byte> log_;
  std::span<const std::byte> local_memory_;
  std::uint32_t window_offset_;
  HintLogHead& head_;
};

class HintReplayer {
 public:
  /// Sets the NIU window up.
  HintReplayer(std::span<std::byte> log, std::span<std::byte> local_memory);

  /// As NiuProcessorSide::hint. stop: at the end of the log, or where the PE does not do what it did when recorded.
  NiuProcessorSide::Result hint(std::int32_t immediate, std::uint64_t clock);
  bool at_end() const { return next_ == entries_.size(); }

 private:
  HintLogEntry apply();

  HintLogHead& head_;
  std::span<const std::byte> entries_;
  std::span<std::byte> local_memory_;
  std::size_t next_ = 0;
};

}  // namespace torolux
