// SPDX-License-Identifier: MIT
// Two engines side by side: the machine's PEs run on QEMU, and each has a shadow on the translated engine, which must
// be where QEMU is at every HINT. Enters: a machine as for any engine; leaves: what was compared, or the first
// difference.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "emulator/engines/engine/engine.hpp"
#include "emulator/engines/translated/run/translated_image.hpp"

namespace torolux::lockstep {

/// What was compared and found equal.
struct Totals {
  std::uint64_t hints = 0;         ///< without phase markers
  std::uint64_t markers = 0;       ///< phase markers
  std::uint64_t instructions = 0;  ///< of QEMU, and as many of the translated engine
  std::uint64_t bytes = 0;         ///< of local memory, that had ever been touched, summed over HINTs
};

struct Options {
  translated::TranslationOptions translation = {};
  /// The translated engine is given these instead of the machine's: tests see so that a difference is found.
  const Image* other_image = nullptr;
  const LatencyTable* other_latency = nullptr;
  /// Called at the end, also where the engines differed.
  std::function<void(const Totals&)> ended = {};
};

/// As QEMU's engine; `check` throws MachineFailure, with a report, where the engines differ.
std::unique_ptr<Engine> make_engine(const EngineSetup& setup, const Options& options = {});

}  // namespace torolux::lockstep
