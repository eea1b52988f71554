// SPDX-License-Identifier: MIT
// Event queue, bound tree, queues and byte ring against plain models.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "emulator/engines/engine/shared_memory.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/niu/processor_side.hpp"
#include "emulator/time/bound_tree.hpp"
#include "emulator/time/event_queue.hpp"
#include "emulator/time/fifo.hpp"
#include "emulator/time/ready_set.hpp"
#include "emulator/time/slices.hpp"

namespace torolux::test {

namespace {

TEST(EventQueue, OrderIsTimeThenSourceThenSequence) {
  EventQueue queue(5);
  std::minstd_rand random(3);
  std::vector<std::tuple<Cycles, std::uint32_t, std::uint32_t>> expected;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    const Cycles time = random() % 100;
    const auto source = static_cast<std::uint32_t>(random() % 5);
    queue.push(time, source, EventKind::command, 0, 0, i);
    expected.emplace_back(time, source, i);
  }
  std::ranges::sort(expected);
  for (const auto& [time, source, block] : expected) {
    const Event event = queue.pop();
    ASSERT_EQ(event.time, time);
    ASSERT_EQ(event.order >> 32U, source);
    ASSERT_EQ(event.block, block);
  }
  EXPECT_TRUE(queue.empty());
}

/// Pushes and pops in turn, near, far and backwards in time, at the time of what was just popped too.
TEST(EventQueue, KeepsTheOrderWhilePushingAndPopping) {
  for (const std::uint32_t spread : {1U, 3U, 50U, 2000U, 40'000U, 1'000'000U}) {
    constexpr std::uint32_t kSources = 7;
    EventQueue queue(kSources);
    std::minstd_rand random(spread);
    std::set<std::tuple<Cycles, std::uint32_t, std::uint32_t>> model;
    Cycles now = 5000;
    std::uint32_t number = 0;
    for (int step = 0; step < 20000; ++step) {
      const bool grow = step / 500 % 2 == 0;
      for (auto i = random() % (grow ? 4 : 2); i > 0; --i) {
        Cycles time = now + random() % spread;
        if (random() % 50 == 0) time += 5000;
        if (random() % 50 == 0) time = now - random() % 100;
        const auto source = static_cast<std::uint32_t>(random() % kSources);
        queue.push(time, source, EventKind::command, 0, 0, number);
        model.emplace(time, source, number++);
      }
      ASSERT_EQ(queue.empty(), model.empty());
      ASSERT_EQ(queue.next_time(), model.empty() ? EventQueue::kNone : std::get<0>(*model.begin()));
      if (model.empty()) continue;
      const Event event = queue.pop();
      ASSERT_EQ(std::tuple(event.time, static_cast<std::uint32_t>(event.order >> 32U), event.block), *model.begin());
      model.erase(model.begin());
      now = std::max(now, event.time);
    }
  }
}

class Announced final : public EventWatcher {
 public:
  void soon(const Event& event) override { announced.emplace(event.block, event.time); }
  std::map<std::uint32_t, Cycles> announced;  ///< by block
};

TEST(EventQueue, TellsOfWhatWasPushedLongBefore) {
  EventQueue queue(1);
  Announced watcher;
  queue.watch(&watcher);
  std::minstd_rand random(11);
  std::vector<Cycles> pushed_at;
  Cycles now = 0;
  for (int step = 0; step < 20'000; ++step) {
    if (random() % 2 == 0) {
      queue.push(now + random() % 20'000, 0, EventKind::command, 0, 0, static_cast<std::uint32_t>(pushed_at.size()));
      pushed_at.push_back(now);
    }
    if (queue.empty() || random() % 2 == 0) continue;
    const Event event = queue.pop();
    now = event.time;
    const bool told = watcher.announced.contains(event.block);
    const Cycles ahead = event.time - pushed_at[event.block];
    if (ahead >= 2 * EventQueue::kSpan) {
      ASSERT_TRUE(told) << ahead;
      ASSERT_EQ(watcher.announced.at(event.block), event.time);
    } else if (ahead <= EventQueue::kSpan) {
      ASSERT_FALSE(told) << "it was near at once: " << ahead;
    }
  }
  EXPECT_GT(watcher.announced.size(), 1000U);
}

TEST(BoundTree, GivesTheLeastAndTheLowestOfEquals) {
  for (const std::size_t count : {1U, 2U, 3U, 7U, 16U, 100U}) {
    BoundTree tree(count, 5);
    std::vector<std::uint64_t> model(count, 5);
    std::minstd_rand random(static_cast<unsigned>(count));
    for (int i = 0; i < 2000; ++i) {
      const std::size_t at = random() % count;
      model[at] = random() % 20 == 0 ? kNever : random() % 50;
      tree.set(at, model[at]);
      const auto least = std::ranges::min_element(model);
      ASSERT_EQ(tree.least(), *least);
      if (*least == kNever) continue;
      ASSERT_EQ(tree.least_index(), static_cast<std::size_t>(least - model.begin()));
      std::vector<std::uint64_t> others = model;
      others.erase(others.begin() + (least - model.begin()));
      if (others.empty()) continue;
      ASSERT_NE(tree.second_index(), tree.least_index());
      ASSERT_LT(tree.second_index(), count);
      ASSERT_EQ(tree.at(tree.second_index()), *std::ranges::min_element(others));
    }
  }
}

TEST(ReadySet, GivesTurnsInACircle) {
  std::minstd_rand random(5);
  for (const std::size_t count : {1U, 63U, 64U, 65U, 4096U, 9000U}) {
    ReadySet set(count);
    std::vector<bool> model(count);
    EXPECT_TRUE(set.empty());
    for (int i = 0; i < 400; ++i) {
      const std::size_t at = random() % count;
      model[at] = random() % 3 == 0;
      set.set(at, model[at]);
      const std::size_t from = random() % (count + 1);
      std::size_t expected = ReadySet::kNobody;
      for (std::size_t k = 0; k < count && expected == ReadySet::kNobody; ++k) {
        if (model[(from + k) % count]) expected = (from + k) % count;
      }
      ASSERT_EQ(set.next(from), expected) << from << " of " << count;
      ASSERT_EQ(set.empty(), expected == ReadySet::kNobody);
      ASSERT_EQ(set.has(at), model[at]);
    }
  }
}

TEST(Slices, HoldWhateverTheOrderAndTheLength) {
  // Against one counter for each cycle, over a time for which the width doubles five times.
  constexpr std::uint64_t kEnd = (kSlices << kLeastSliceShift) * 20;
  std::minstd_rand random(7);
  auto slices = std::make_unique<Slices<std::uint64_t>>();
  std::vector<std::uint32_t> model(kEnd);
  for (int i = 0; i < 300; ++i) {
    const std::uint64_t begin = random() % (kEnd * (static_cast<std::uint64_t>(i) + 1) / 300);
    const std::uint64_t end = std::min(kEnd, begin + random() % 30'000);
    slices->add_interval(begin, end, 2);
    for (std::uint64_t t = begin; t < end; ++t) model[t] += 2;
    slices->add(begin, 1);
    ++model[begin];
  }
  slices->widen(slice_shift_for(kEnd - 1));
  const std::uint64_t width = std::uint64_t{1} << slices->shift();
  EXPECT_LE(kEnd, width * kSlices);
  EXPECT_GT(kEnd, width / 2 * kSlices) << "no wider than needed";
  for (std::size_t i = 0; i < kSlices; ++i) {
    std::uint64_t expected = 0;
    for (std::uint64_t t = i * width; t < std::min(kEnd, (i + 1) * width); ++t) expected += model[t];
    EXPECT_EQ(slices->sums()[i], expected) << i;
  }
}

struct RingAndBytes {
  ByteRing<Arrival, 4096, kRingBytes> ring;
  std::array<std::byte, 4096> bytes;
};
static_assert(offsetof(RingAndBytes, bytes) == kRingBytes);

TEST(ByteRing, KeepsEntriesWholeAcrossItsEnd) {
  const auto both = std::make_unique<RingAndBytes>();
  auto* const ring = &both->ring;
  std::minstd_rand random(9);
  std::vector<std::vector<std::byte>> inside;
  std::uint64_t pushed = 0;
  std::uint64_t popped = 0;
  for (int i = 0; i < 20000; ++i) {
    std::vector<std::byte> payload(random() % 1025);
    for (std::byte& one : payload) one = static_cast<std::byte>(random());
    if (random() % 2 == 0 && ring->has_room(payload.size())) {
      ring->push({pushed++, 1, 2, 3, 4, 0, 0}, payload);
      inside.push_back(payload);
    }
    if (random() % 2 == 0) {
      const Arrival* front = ring->front();
      ASSERT_EQ(front == nullptr, inside.empty());
      if (front == nullptr) continue;
      ASSERT_EQ(front->time, popped++);
      ASSERT_TRUE(std::ranges::equal(ring->payload(*front), inside.front()));
      ring->pop(*front);
      inside.erase(inside.begin());
    }
  }
  EXPECT_GT(popped, 5000U);
}

/// Channels with rings of any size have all of them where there is memory for them, and apart.
TEST(ByteRing, LiesInItsOwnMemory) {
  for (const std::uint32_t bytes : {kLeastRingBytes, kMostRingBytes}) {
    SharedMemory memory("test-channel", channel_bytes(bytes));
    NiuChannel& channel = *niu_channel_at(memory.bytes().data());
    channel.set_ring_bytes(bytes);
    const std::vector<std::byte> payload(500, std::byte{7});
    std::uint32_t pushed = 0;
    while (channel.commands.has_room(payload.size())) {
      channel.commands.push({pushed, CommandKind::release, 0, 0, 0, 0, 0, 0}, payload);
      channel.arrivals.push({pushed, 0, 0, 0, 0, 0, 0}, payload);
      ++pushed;
    }
    EXPECT_GT(pushed, bytes / 600);
    EXPECT_GT(reinterpret_cast<const std::byte*>(channel.commands.front()), memory.bytes().data());
    for (std::uint32_t i = 0; i < pushed; ++i) {
      const Command* command = channel.commands.front();
      const Arrival* arrival = channel.arrivals.front();
      ASSERT_EQ(command->time, i);
      ASSERT_EQ(arrival->time, i);
      ASSERT_TRUE(std::ranges::equal(channel.commands.payload(*command), payload));
      ASSERT_TRUE(std::ranges::equal(channel.arrivals.payload(*arrival), payload));
      const auto* end = channel.arrivals.payload(*arrival).data() + payload.size();
      ASSERT_LE(end, memory.bytes().data() + memory.bytes().size());
      channel.commands.pop(*command);
      channel.arrivals.pop(*arrival);
    }
    EXPECT_TRUE(channel.commands.empty() && channel.arrivals.empty());
  }
}

TEST(ByteRing, BeginsAtItsStartWheneverItIsEmpty) {
  const auto both = std::make_unique<RingAndBytes>();
  auto* const ring = &both->ring;
  const std::vector<std::byte> payload(100);
  ring->push({0, 1, 2, 3, 4, 0, 0}, payload);
  const Arrival* first = ring->front();
  ring->push({1, 1, 2, 3, 4, 0, 0}, payload);
  ring->pop(*first);
  EXPECT_NE(ring->front(), first) << "it is not empty";
  ring->pop(*ring->front());
  for (std::uint64_t i = 2; i < 100; ++i) {
    ring->push({i, 1, 2, 3, 4, 0, 0}, payload);
    ASSERT_EQ(ring->front(), first);
    ASSERT_EQ(first->time, i);
    ring->pop(*first);
  }
}

TEST(Fifo, KeepsTheOrderWhileGrowingAndShrinking) {
  Fifo<std::uint32_t> fifo;
  std::deque<std::uint32_t> model;
  std::minstd_rand random(4);
  for (std::uint32_t i = 0; i < 50'000; ++i) {
    const bool grows = i / 1000 % 2 == 0;
    if (random() % (grows ? 2 : 4) == 0) {
      fifo.push_back(i);
      model.push_back(i);
    } else if (random() % (grows ? 4 : 2) == 0 && !model.empty()) {
      ASSERT_EQ(fifo.front(), model.front());
      fifo.pop_front();
      model.pop_front();
    }
    ASSERT_EQ(fifo.empty(), model.empty());
    if (i % 100 != 0) continue;
    ASSERT_TRUE(std::ranges::equal(fifo.inside(), model));
  }
}

TEST(Fifo, TakesNoMoreThanTwiceWhatIsInside) {
  Fifo<std::uint32_t> fifo;
  fifo.push_back(0);
  const std::uint32_t* first = fifo.inside().data();
  for (std::uint32_t i = 1; i < 1000; ++i) {
    fifo.pop_front();
    fifo.push_back(i);
    ASSERT_EQ(fifo.inside().data(), first) << "empty each time";
  }
  for (std::uint32_t i = 0; i < 100; ++i) fifo.push_back(i);
  for (std::uint32_t i = 0; i < 100'000; ++i) {
    fifo.push_back(i);
    fifo.pop_front();
  }
  EXPECT_LE(fifo.capacity(), 512U) << "101 and as many gone, doubled as vectors grow";
}

}  // namespace

}  // namespace torolux::test
