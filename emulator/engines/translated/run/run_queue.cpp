// SPDX-License-Identifier: MIT
// A state for each PE, changed by compare-and-swap; a queue of those that are ready, under a lock.
#include "emulator/engines/translated/run/run_queue.hpp"

#include <chrono>

#include "emulator/pause.hpp"

namespace torolux::translated {
namespace {

/// Looks for a ready PE before a taker sleeps: some 100 microseconds, a few times what it takes to wake up again.
constexpr int kLooks = 2500;
/// So that a taker sees the end of the machine.
constexpr std::chrono::milliseconds kLongestSleep{50};

}  // namespace

RunQueue::RunQueue(std::size_t pes, unsigned takers) : entries_(pes), takers_(takers) {
  for (unsigned pe = 0; pe < pes; ++pe) make_ready(pe);
}

/// Its state has become `ready`.
void RunQueue::make_ready(unsigned pe) {
  if (takers_ == 0) return;
  {
    const std::lock_guard lock(mutex_);
    if (!entries_[pe].queued) queue_.push_back(pe);
    entries_[pe].queued = true;
  }
  ready_pes_.fetch_add(1);
  wake_taker();
}

/// Sleeping takers have said so before they look once more: either they see the PE, or they are seen.
void RunQueue::wake_taker() {
  if (sleepers_.load() == 0 || !may_take()) return;
  mutex_.lock();  // one that has looked sleeps by now
  mutex_.unlock();
  ready_.notify_one();
}

std::optional<unsigned> RunQueue::pop() {
  const std::lock_guard lock(mutex_);
  while (!queue_.empty()) {
    const unsigned pe = queue_.front();
    queue_.pop_front();
    entries_[pe].queued = false;
    State expected = State::ready;
    if (entries_[pe].state.compare_exchange_strong(expected, State::running)) {
      ready_pes_.fetch_sub(1);
      return pe;
    }
  }
  return std::nullopt;
}

void RunQueue::wake(unsigned pe) {
  std::atomic<State>& state = entries_[pe].state;
  State seen = state.load();
  for (;;) {
    if (seen == State::parked) {
      if (state.compare_exchange_weak(seen, State::ready)) return make_ready(pe);
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
    const bool was_ready = seen == State::ready;
    if (!state.compare_exchange_weak(seen, State::running)) continue;
    if (was_ready && takers_ != 0) ready_pes_.fetch_sub(1);
    return true;
  }
  return false;
}

std::optional<unsigned> RunQueue::take() {
  return ready_pes_.load(std::memory_order_relaxed) > 0 ? pop() : std::nullopt;
}

std::optional<unsigned> RunQueue::wait_and_take() {
  idle_.fetch_add(1);
  for (int i = 0; i < kLooks && !may_take(); ++i) torolux::pause();
  if (!may_take()) {
    std::unique_lock lock(mutex_);
    sleepers_.fetch_add(1);
    if (!may_take() && !closed_) ready_.wait_for(lock, kLongestSleep);
    sleepers_.fetch_sub(1);
  }
  const auto pe = may_take() ? pop() : std::nullopt;
  idle_.fetch_sub(1);
  return pe;
}

void RunQueue::scheduler_runs_pe(bool runs) {
  if (takers_ == 0) return;
  kept_.store(runs ? 0 : 1);
  if (runs) wake_taker();
}

bool RunQueue::park(unsigned pe) {
  State expected = State::running;
  if (entries_[pe].state.compare_exchange_strong(expected, State::parked)) return true;
  entries_[pe].state.store(State::running);
  return false;
}

void RunQueue::put_back(unsigned pe) {
  entries_[pe].state.store(State::ready);
  make_ready(pe);
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
