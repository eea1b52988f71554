// SPDX-License-Identifier: MIT
// The PEs of a run once more, each with what its NIU gave it instead of a NIU: the same instructions on the same data,
// with no network, no emulator and no waiting. On QEMU, translated, and as code of this computer.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "emulator/description/description.hpp"
#include "emulator/engines/engine/engine.hpp"
#include "emulator/engines/image/image.hpp"

namespace torolux {

/// Instructions executed, and what they took.
struct EngineSpeed {
  std::uint64_t instructions = 0;
  double wall_seconds = 0;  ///< from the start of the first PE to the end of the last
  double cpu_seconds = 0;   ///< of the processes or threads that ran them, all together

  double instructions_per_second() const {
    return wall_seconds > 0 ? static_cast<double>(instructions) / wall_seconds : 0;
  }
  double instructions_per_cpu_second() const {
    return cpu_seconds > 0 ? static_cast<double>(instructions) / cpu_seconds : 0;
  }
};

/// What the NIUs of a run gave its PEs.
struct Recording {
  Image image;
  MachineDescription machine;
  std::uint32_t local_memory_bytes = 0;
  std::uint64_t instructions = 0;  ///< of all PEs
  std::vector<SharedMemory> logs;  ///< of each PE; see emulator/engines/qemu/hint_log.hpp
  bool whole = true;               ///< false: only the beginning of the run, as a log was full
};

struct RecordedFigures {
  std::uint32_t local_memory_bytes;
  std::uint64_t instructions;  ///< of all PEs
};
/// Runs the image once, on the engine named.
using RecordedRun = std::function<RecordedFigures(const std::string& engine)>;

/// Calls `run` with an engine that records. pes: of the run.
Recording record(const Image& image, const MachineDescription& machine, std::size_t pes, const RecordedRun& run);

/// Each starts all PEs again, `threads` (>= 1) at a time, and measures. Start and end of QEMU's processes count.
/// Throws MachineFailure where a PE does not repeat what it did.
EngineSpeed replay_on_qemu(Recording& recording, unsigned threads);
EngineSpeed replay_on_translated(Recording& recording, unsigned threads);

/// Executes a HINT; false: the PE is to end.
using NativeHint = std::function<bool(std::int32_t immediate)>;
/// A PE's program compiled for this computer: runs until it has ended.
using NativeProgram =
    std::function<void(const Image& image, std::span<std::byte> local_memory, const NativeHint& hint)>;

/// `torolux` itself has no firmware in it; programs that have give it to the benchmarks. image: its file's stem.
void register_native_program(std::string_view image, NativeProgram program);
bool has_native_program(const Image& image);
/// The image must have a native program.
EngineSpeed replay_natively(Recording& recording, unsigned threads);

}  // namespace torolux
