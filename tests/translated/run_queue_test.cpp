// SPDX-License-Identifier: MIT
// The queue of PEs that may run: under threads that wake, take, claim and park at random no wake-up is lost and no PE
// is on two threads at once.
#include "emulator/engines/translated/run/run_queue.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <random>
#include <thread>
#include <vector>

namespace torolux::test {
namespace {

using translated::RunQueue;

/// PEs whose work is to take what a waker has put down for them.
class Pes {
 public:
  Pes(std::size_t pes, unsigned takers) : queue(pes, takers), parts_(pes) {}

  /// Only where the last one has been taken: nothing else would wake the PE if that were lost.
  bool put_down(unsigned pe) {
    if (parts_[pe].put.load() != 0) return false;
    parts_[pe].put.store(1);
    queue.wake(pe);
    return true;
  }
  void run(unsigned pe, std::minstd_rand& random) {
    Part& part = parts_[pe];
    do {
      if (part.running.exchange(true)) broken = true;
      part.taken += part.put.exchange(0);
      part.running = false;
      if (random() % 8 == 0) return queue.put_back(pe);
    } while (!queue.park(pe));
  }
  std::uint64_t taken() const {
    std::uint64_t sum = 0;
    for (const Part& part : parts_) sum += part.taken;
    return sum;
  }

  RunQueue queue;
  std::atomic<bool> broken = false;

 private:
  struct Part {
    std::atomic<std::uint32_t> put = 0;
    std::atomic<std::uint64_t> taken = 0;
    std::atomic<bool> running = false;
  };
  std::vector<Part> parts_;
};

TEST(RunQueue, LosesNoWakeUpAndRunsEachPeOnOneThread) {
  constexpr unsigned kPes = 5;
  constexpr unsigned kTakers = 3;
  constexpr std::uint64_t kWakeUps = 100'000;
  Pes pes(kPes, kTakers);
  std::atomic<bool> ending = false;
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < kTakers; ++i) {
    threads.emplace_back([&, i] {
      std::minstd_rand random(i + 1);
      while (!ending) {
        if (const auto pe = pes.queue.wait_and_take()) pes.run(*pe, random);
      }
    });
  }
  // The scheduler: wakes, and helps PE 0 now and then.
  std::minstd_rand random(99);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  std::uint64_t woken = 0;
  for (unsigned pe = 0; pes.taken() < kWakeUps && std::chrono::steady_clock::now() < deadline; pe = (pe + 1) % kPes) {
    if (woken < kWakeUps && pes.put_down(pe)) ++woken;
    if (random() % 4 == 0 && pes.queue.claim(0)) pes.run(0, random);
  }
  EXPECT_EQ(pes.taken(), kWakeUps);
  EXPECT_FALSE(pes.broken);
  ending = true;
  pes.queue.close();
  for (std::thread& thread : threads) thread.join();
}

TEST(RunQueue, FinishedPesAreNotGivenOut) {
  RunQueue queue(2, 1);
  ASSERT_TRUE(queue.claim(0));
  EXPECT_FALSE(queue.claim(0)) << "it is somebody's";
  queue.finish(0);
  queue.wake(0);
  EXPECT_FALSE(queue.claim(0));
  EXPECT_EQ(queue.take(), 1U);
  EXPECT_TRUE(queue.park(1));
  EXPECT_EQ(queue.take(), std::nullopt) << "it waits";
  queue.wake(1);
  EXPECT_EQ(queue.take(), 1U);
}

TEST(RunQueue, TheLongestReadyComesFirst) {
  RunQueue queue(3, 1);
  EXPECT_EQ(queue.take(), 0U);
  queue.put_back(0);
  EXPECT_EQ(queue.take(), 1U);
  EXPECT_EQ(queue.take(), 2U);
  EXPECT_EQ(queue.take(), 0U);
}

}  // namespace
}  // namespace torolux::test
