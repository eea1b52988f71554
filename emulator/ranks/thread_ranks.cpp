// SPDX-License-Identifier: MIT
// A queue for each pair of ranks in common memory; a message has a time before which it is not there.
#include "emulator/ranks/thread_ranks.hpp"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

namespace torolux::ranks {
namespace {

using Clock = std::chrono::steady_clock;

/// SplitMix64 (Steele, Lea, Flood 2014).
std::uint64_t mixed(std::uint64_t value) {
  value += 0x9E3779B97F4A7C15U;
  value = (value ^ (value >> 30U)) * 0xBF58476D1CE4E5B9U;
  value = (value ^ (value >> 27U)) * 0x94D049BB133111EBU;
  return value ^ (value >> 31U);
}

struct Late {
  Clock::time_point due;
  Message message;
};

/// Messages of one rank to another that are under way.
struct Lane {
  std::deque<Late> messages;
  std::uint64_t sent = 0;
  Clock::time_point last_due;
};

/// What all ranks share.
struct Hub {
  Hub(unsigned count, const Delays& chosen) : ranks(count), delays(chosen), lanes(std::size_t{count} * count) {}
  Lane& lane(unsigned from, unsigned to) { return lanes[std::size_t{from} * ranks + to]; }

  unsigned ranks;
  Delays delays;
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<Lane> lanes;
  unsigned closed = 0;
  std::string failure;  ///< of the rank that has ended all; empty: none
};

class ThreadRank : public Transport {
 public:
  ThreadRank(Hub& hub, unsigned own) : hub_(hub), own_(own) {}

  Ranks ranks() const override { return {own_, hub_.ranks}; }
  void send(unsigned to, std::uint32_t kind, std::span<const std::byte> bytes) override {
    const std::lock_guard lock(hub_.mutex);
    check();
    Lane& lane = hub_.lane(own_, to);
    const std::uint64_t random =
        mixed(mixed(hub_.delays.seed) ^ mixed((std::uint64_t{own_} << 32U) + to) ^ mixed(~lane.sent++));
    const auto late = std::chrono::microseconds(random % (static_cast<std::uint64_t>(hub_.delays.most.count()) + 1));
    lane.last_due = std::max(lane.last_due, Clock::now() + late);
    lane.messages.push_back({lane.last_due, {own_, kind, {bytes.begin(), bytes.end()}}});
    hub_.changed.notify_all();
  }
  std::optional<Message> poll() override {
    const std::lock_guard lock(hub_.mutex);
    check();
    Lane* lane = next();
    if (lane == nullptr || lane->messages.front().due > Clock::now()) return std::nullopt;
    Message message = std::move(lane->messages.front().message);
    lane->messages.pop_front();
    return message;
  }
  bool wait(std::chrono::milliseconds limit) override {
    const Clock::time_point end = Clock::now() + limit;
    std::unique_lock lock(hub_.mutex);
    for (;;) {
      check();
      const Lane* lane = next();
      const Clock::time_point now = Clock::now();
      if (lane != nullptr && lane->messages.front().due <= now) return true;
      if (now >= end) return false;
      hub_.changed.wait_until(lock, lane != nullptr ? std::min(end, lane->messages.front().due) : end);
    }
  }
  [[noreturn]] void abort(const std::string& reason) override {
    const std::lock_guard lock(hub_.mutex);
    if (hub_.failure.empty()) hub_.failure = "rank " + std::to_string(own_) + ": " + reason;
    hub_.changed.notify_all();
    throw RankFailure(hub_.failure);
  }
  void close(std::span<const unsigned> lost, int /*exit_code*/) override {
    std::unique_lock lock(hub_.mutex);
    check();
    ++hub_.closed;
    hub_.changed.notify_all();
    if (!lost.empty()) return;
    hub_.changed.wait(lock, [this] { return hub_.closed == hub_.ranks || !hub_.failure.empty(); });
    check();
  }

 private:
  /// The lane to this rank whose first message is due first; null: all are empty.
  Lane* next() {
    Lane* first = nullptr;
    for (unsigned from = 0; from < hub_.ranks; ++from) {
      Lane& lane = hub_.lane(from, own_);
      if (lane.messages.empty()) continue;
      if (first == nullptr || lane.messages.front().due < first->messages.front().due) first = &lane;
    }
    return first;
  }
  void check() const {
    if (!hub_.failure.empty()) throw RankFailure(hub_.failure);
  }

  Hub& hub_;
  unsigned own_;
};

}  // namespace

std::vector<std::string> run_as_threads(unsigned count, const Delays& delays,
                                        const std::function<void(Transport&)>& rank) {
  Hub hub(count, delays);
  std::vector<std::string> ends(count);
  {
    std::vector<std::jthread> threads;
    threads.reserve(count);
    for (unsigned own = 0; own < count; ++own) {
      threads.emplace_back([&hub, &rank, &end = ends[own], own] {
        try {
          ThreadRank transport(hub, own);
          rank(transport);
        } catch (const std::exception& error) {
          end = error.what();
        }
      });
    }
  }
  return ends;
}

}  // namespace torolux::ranks
