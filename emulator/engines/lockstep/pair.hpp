// SPDX-License-Identifier: MIT
// One PE in lock step: QEMU in its process, the shadow here, a thread that takes the shadow from HINT to HINT,
// compares, and does what the HINT does.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "emulator/engines/lockstep/lockstep_engine.hpp"
#include "emulator/engines/lockstep/shadow.hpp"

namespace torolux::lockstep {

/// What is the same for all PEs of an image.
struct Common {
  EngineSetup setup;
  const translated::TranslatedImage& code;
  const translated::CodeMap& map;  ///< of that image and the machine's latency table: what is right
};

class Pair {
 public:
  /// meeting: a HintMeeting, zeroed. All outlive this.
  Pair(const Common& common, unsigned number, SharedMemory& meeting);
  Pair(const Pair&) = delete;
  Pair& operator=(const Pair&) = delete;
  ~Pair() { end(); }

  void start();
  /// The report where the engines differ. Any thread.
  std::optional<std::string> difference() const;
  /// Ends the thread. The channel has been told to stop.
  void end();
  /// After `end`.
  const Totals& totals() const { return totals_; }

 private:
  void work();
  bool await_qemu();
  bool compare();
  void take_hint();

  const Common& common_;
  unsigned number_;
  SharedMemory& local_;
  HintMeeting& meeting_;
  std::uint32_t window_offset_;
  NiuProcessorSide niu_;
  Shadow shadow_;
  std::uint64_t last_hint_clock_ = 0;
  Totals totals_;
  std::thread thread_;
  std::atomic<bool> ending_ = false;
  mutable std::mutex mutex_;
  std::optional<std::string> difference_;  // guarded by mutex_
};

}  // namespace torolux::lockstep
