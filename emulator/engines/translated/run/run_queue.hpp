// SPDX-License-Identifier: MIT
// Which PEs may run, each on one thread at a time. Enters: wake-ups, and how each run ended; leaves: the next PE to
// run.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

namespace torolux::translated {

/// Any thread may call anything. A wake-up is never lost: one that comes while the PE runs makes `park` fail.
class RunQueue {
 public:
  /// All PEs may run. takers: threads that will call `take`, 0: all PEs are claimed by number.
  RunQueue(std::size_t pes, unsigned takers);

  /// The PE may go on.
  void wake(unsigned pe);
  /// Makes it the caller's, to run it. False: it is running, or finished. Also one that waits: it may look again.
  bool claim(unsigned pe);
  /// It will never run again.
  bool has_finished(unsigned pe) const { return entries_[pe].state.load() == State::finished; }
  /// The PE that has been ready for longest, or nothing. For the scheduler's thread.
  std::optional<unsigned> take();
  /// The same for a taker: waits a while for one, and leaves one to a scheduler that is not running a PE.
  std::optional<unsigned> wait_and_take();
  /// The scheduler's thread begins or ends to run a PE.
  void scheduler_runs_pe(bool runs);
  /// Whether a taker has nothing to do.
  bool has_idle_takers() const { return idle_.load(std::memory_order_relaxed) != 0; }

  /// The caller's PE waits. False: it has been woken meanwhile, and is still the caller's.
  bool park(unsigned pe);
  /// The caller's PE can go on; another thread may take it.
  void put_back(unsigned pe);
  /// The caller's PE will never run again.
  void finish(unsigned pe);

  /// Ends all sleep in `take`, for good.
  void close();

 private:
  enum class State : std::uint8_t { parked, ready, running, woken /* while running */, finished };
  struct alignas(64) Entry {
    std::atomic<State> state = State::ready;
    bool queued = false;  // guarded by mutex_
  };
  bool may_take() const { return ready_pes_.load() > kept_.load(); }
  void make_ready(unsigned pe);
  void wake_taker();
  std::optional<unsigned> pop();

  std::vector<Entry> entries_;
  unsigned takers_;
  std::mutex mutex_;
  std::condition_variable ready_;
  std::deque<unsigned> queue_;  // may name PEs that are not ready any more
  std::atomic<int> ready_pes_ = 0;
  std::atomic<int> kept_ = 1;  // ready PEs that takers leave alone
  std::atomic<unsigned> idle_ = 0, sleepers_ = 0;
  bool closed_ = false;
};

}  // namespace torolux::translated
