// SPDX-License-Identifier: MIT
// A state for each PE, changed by compare-and-swap; a queue of those that are ready, under a lock.
#include "emulator/engines/translated/run_queue.hpp"

#include <chrono>

namespace torolux::translated {
namespace {

/// Looks at the queue before a thread sleeps: some ten microseconds, a few times what an event takes.
constexpr int kLooks = 300;
/// So that a thread sees the end of the machine.
constexpr std::chrono::milliseconds kLongestSleep{50};

}  // namespace

RunQueue::RunQueue(std::size_t pes, unsigned takers) : entries_(pes), takers_(takers) {
  for (unsigned pe = 0; pe < pes; ++pe) push(pe);
}

void RunQueue::push(unsigned pe) {
  if (takers_ == 0) return;
  const std::lock_guard lock(mutex_);
  if (entries_[pe].queued) return;
  entries_[pe].queued = true;
  queue_.push_back(pe);
  length_.store(queue_.size(), std::memory_order_relaxed);
  if (sleepers_ != 0) ready_.notify_one();
}

std::optional<unsigned> RunQueue::pop() {
  while (!queue_.empty()) {
    const unsigned pe = queue_.front();
    queue_.pop_front();
    length_.store(queue_.size(), std::memory_order_relaxed);
    entries_[pe].queued = false;
    State expected = State::ready;
    if (entries_[pe].state.compare_exchange_strong(expected, State::running)) return pe;
  }
  return std::nullopt;
}

void RunQueue::wake(unsigned pe) {
  std::atomic<State>& state = entries_[pe].state;
  State seen = state.load();
  for (;;) {
    if (seen == State::parked) {
      if (state.compare_exchange_weak(seen, State::ready)) return push(pe);
    } else if (seen == State::running) {
      if (state.compare_exchange_weak(seen, State::woken)) return;
    } else {
      return;
    }
  }
}

bool RunQueue::claim(unsigned pe) {
  std::atomic<State>& state = entries_[pe].state;
  State seen = state.load();
  while (seen == State::ready || seen == State::parked) {
    if (state.compare_exchange_weak(seen, State::running)) return true;
  }
  return false;
}

std::optional<unsigned> RunQueue::take(bool sleeps) {
  for (int i = 0; sleeps && i < kLooks && length_.load(std::memory_order_relaxed) == 0; ++i) __builtin_ia32_pause();
  if (!sleeps && length_.load(std::memory_order_relaxed) == 0) return std::nullopt;
  std::unique_lock lock(mutex_);
  if (const auto pe = pop()) return pe;
  if (!sleeps || closed_) return std::nullopt;
  ++sleepers_;
  ready_.wait_for(lock, kLongestSleep);
  --sleepers_;
  return pop();
}

bool RunQueue::park(unsigned pe) {
  State expected = State::running;
  if (entries_[pe].state.compare_exchange_strong(expected, State::parked)) return true;
  entries_[pe].state.store(State::running);
  return false;
}

void RunQueue::put_back(unsigned pe) {
  entries_[pe].state.store(State::ready);
  push(pe);
}

void RunQueue::finish(unsigned pe) {
  entries_[pe].state.store(State::finished);
}

void RunQueue::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  ready_.notify_all();
}

}  // namespace torolux::translated
