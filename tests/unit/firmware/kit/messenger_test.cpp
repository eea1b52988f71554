// SPDX-License-Identifier: MIT
// Proves that messages arrive whole and in the order of each sender, and that barrier, broadcast and reduce do what
// they say, however packets are delayed, diverted and brought in another order.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>

#include "firmware/kit/call.hpp"
#include "firmware/kit/messenger.hpp"
#include "firmware/kit/together.hpp"
#include "firmware/niu/native/fake_torus.hpp"

namespace torolux::test {
namespace {

using kit::Channel;
using kit::Messenger;
using native::FakeNode;
using native::FakeTorus;
using Bytes = std::vector<std::byte>;

kit::SlotLayout layout() {
  return kit::slot_layout(protocol::kLocalMemoryBase, protocol::kLocalMemoryBase + FakeTorus::kMemoryBytes);
}

void check(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error(what);
}

std::byte byte_of(unsigned from, unsigned to, unsigned number, std::size_t at) {
  return static_cast<std::byte>(from * 131 + to * 29 + number * 7 + at + at / 255);
}
Bytes message_of(unsigned from, unsigned to, unsigned number, std::size_t bytes) {
  Bytes message(bytes);
  for (std::size_t at = 0; at < bytes; ++at) message[at] = byte_of(from, to, number, at);
  return message;
}

/// What travels in one run: for each pair, the lengths of its messages.
struct Traffic {
  unsigned columns, rows;
  double divert;
  std::uint32_t seed;
  std::vector<std::size_t> lengths;  ///< of the messages of every pair, in order
};

Traffic any_traffic() {
  Traffic traffic{};
  traffic.columns = *rc::gen::inRange(1U, 4U);
  traffic.rows = *rc::gen::inRange(1U, 3U);
  traffic.divert = *rc::gen::element(0.0, 0.1, 0.9);
  traffic.seed = *rc::gen::arbitrary<std::uint32_t>();
  const auto length = rc::gen::weightedOneOf<std::size_t>(
      {{4, rc::gen::element<std::size_t>(0, 1, 47, 48, 49, 63, 111, 112, 113, 1007, 1008, 1009, 3000)},
       {1, rc::gen::inRange<std::size_t>(0, 9000)}});
  traffic.lengths = *rc::gen::resize(6, rc::gen::container<std::vector<std::size_t>>(length));
  return traffic;
}

/// From the PE's own memory, at any place, or from elsewhere.
std::span<const std::byte> somewhere(FakeNode& node, const Bytes& message, unsigned number) {
  if (number % 3 == 0 || message.empty()) return message;
  const auto memory = node.memory();
  const std::size_t place = number * 37 % 100;
  std::ranges::copy(message, memory.begin() + static_cast<std::ptrdiff_t>(place));
  return memory.subspan(place, message.size());
}

void send_all(FakeNode& node, Messenger& messenger, const Traffic& traffic, unsigned pes) {
  const unsigned own = node.niu().pe();
  for (unsigned number = 0; number < traffic.lengths.size(); ++number) {
    for (unsigned step = 0; step < pes; ++step) {
      const unsigned to = (own + step) % pes;
      const Bytes message = message_of(own, to, number, traffic.lengths[number]);
      messenger.send(Channel::program, static_cast<int>(to), somewhere(node, message, number + step));
    }
  }
}

void expect(const Messenger& messenger, std::span<const std::byte> got, const Bytes& sent, unsigned from) {
  check(messenger.source() == from, "the sender");
  check(std::ranges::equal(got, sent), "the bytes of a message of " + std::to_string(sent.size()));
}

RC_GTEST_PROP(Messenger, BringsEachSendersMessagesInOrder, ()) {
  const Traffic traffic = any_traffic();
  const unsigned pes = traffic.columns * traffic.rows;
  FakeTorus torus(traffic.columns, traffic.rows, traffic.divert, traffic.seed);
  torus.run([&](FakeNode& node) {
    Messenger messenger(node.niu(), layout());
    send_all(node, messenger, traffic, pes);
    Bytes room(9001);
    const unsigned own = node.niu().pe();
    for (unsigned step = 0; step < pes; ++step) {
      const unsigned from = (own + 2 * step + 1) % pes;
      if (pes % 2 == 0 && step == pes / 2) break;  // the rest, from whomever, below
      for (unsigned number = 0; number < traffic.lengths.size(); ++number) {
        const std::size_t bytes = messenger.receive(Channel::program, static_cast<int>(from), room);
        expect(messenger, std::span(room).first(bytes), message_of(from, own, number, traffic.lengths[number]), from);
      }
    }
    if (pes % 2 != 0) return;
    std::vector<unsigned> next(pes, 0);
    for (std::size_t left = pes / 2 * traffic.lengths.size(); left != 0; --left) {
      const std::size_t bytes = messenger.receive(Channel::program, kit::kAnyPe, room);
      const unsigned from = messenger.source();
      const unsigned number = next.at(from)++;
      expect(messenger, std::span(room).first(bytes), message_of(from, own, number, traffic.lengths.at(number)), from);
    }
    check(messenger.waiting(Channel::program, kit::kAnyPe) == -1, "nothing is left");
  });
}

RC_GTEST_PROP(Messenger, ExchangesAroundARing, ()) {
  const Traffic traffic = any_traffic();
  const unsigned pes = traffic.columns * traffic.rows;
  FakeTorus torus(traffic.columns, traffic.rows, traffic.divert, traffic.seed);
  torus.run([&](FakeNode& node) {
    Messenger messenger(node.niu(), layout());
    const unsigned own = node.niu().pe();
    const unsigned to = (own + 1) % pes;
    const unsigned from = (own + pes - 1) % pes;
    for (unsigned number = 0; number < traffic.lengths.size(); ++number) {
      const Bytes message = message_of(own, to, number, traffic.lengths[number]);
      Bytes room(traffic.lengths[number] + 1);
      const std::size_t bytes =
          messenger.exchange(static_cast<int>(to), somewhere(node, message, number), static_cast<int>(from), room);
      expect(messenger, std::span(room).first(bytes), message_of(from, own, number, traffic.lengths[number]), from);
    }
  });
}

/// torolux_type, torolux_operation.
constexpr std::uint32_t kUint32 = 1;
constexpr std::uint32_t kSum = 0;

void add_words(std::span<std::byte> into, std::span<const std::byte> from) {
  for (std::size_t at = 0; at < into.size(); at += sizeof(std::uint32_t)) {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    std::memcpy(&a, &into[at], sizeof a);
    std::memcpy(&b, &from[at], sizeof b);
    a += b;
    std::memcpy(&into[at], &a, sizeof a);
  }
}

RC_GTEST_PROP(Together, ReducesBroadcastsAndWaits, ()) {
  const unsigned columns = *rc::gen::inRange(1U, 5U);
  const unsigned rows = *rc::gen::inRange(1U, 4U);
  const unsigned pes = columns * rows;
  const auto root = *rc::gen::inRange(0U, pes);
  const auto count = *rc::gen::element<std::size_t>(0, 1, 251, 252, 253, 1600);
  FakeTorus torus(columns, rows, *rc::gen::element(0.0, 0.3), *rc::gen::arbitrary<std::uint32_t>());
  unsigned inside = 0;
  torus.run([&](FakeNode& node) {
    Messenger messenger(node.niu(), layout());
    const auto together = [&](kit::Call call) { return kit::Together(messenger, call); };
    const unsigned own = node.niu().pe();
    std::vector<std::uint32_t> values(count);
    const auto fill = [&] {
      for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<std::uint32_t>((own + 1) * (i + 3));
    };
    const auto is_sum = [&](std::size_t i) { return values[i] == pes * (pes + 1) / 2 * (i + 3); };
    const auto all_sums = [&] {
      for (std::size_t i = 0; i < count; ++i) check(is_sum(i), "a sum");
    };
    const auto bytes = std::as_writable_bytes(std::span(values));
    fill();
    together(kit::Call::reduce(root, kUint32, kSum)).reduce(root, bytes, add_words);
    if (own == root) all_sums();
    fill();
    together(kit::Call::all_reduce(kUint32, kSum)).all_reduce(bytes, add_words);
    all_sums();
    ++inside;
    together(kit::Call::barrier()).barrier();
    check(inside == pes, "nobody leaves the barrier before all have come");
    together(kit::Call::barrier()).barrier();
    fill();
    together(kit::Call::broadcast(root)).broadcast(root, bytes);
    for (std::size_t i = 0; i < count; ++i) check(values[i] == (root + 1) * (i + 3), "broadcast");
    messenger.end();
  });
}

// ---- Wrong uses ----

template <class Action>
std::uint32_t failure_of(Action action) {
  FakeTorus torus(2, 1, 0, 1);
  try {
    torus.run([&](FakeNode& node) {
      Messenger messenger(node.niu(), layout());
      action(messenger, node.niu().pe());
    });
  } catch (const FakeTorus::Failed& failed) {
    return failed.code;
  }
  return 0;
}

TEST(Messenger, EndsTheRunForWhatCannotBe) {
  constexpr auto kWords = static_cast<std::uint32_t>(protocol::FaultCode::words);
  Bytes room(100);
  EXPECT_EQ(failure_of([](Messenger& m, unsigned) { m.send(Channel::program, 2, {}); }), kWords);
  EXPECT_EQ(failure_of([](Messenger& m, unsigned) { m.send(Channel::program, -1, {}); }), kWords);
  EXPECT_EQ(failure_of([&](Messenger& m, unsigned) { m.receive(Channel::program, 7, room); }), kWords);
  EXPECT_EQ(failure_of([&](Messenger& m, unsigned) {
              const Bytes message(kit::kMostMessage + 1);
              m.send(Channel::program, 0, message);
            }),
            kWords);
  EXPECT_EQ(failure_of([&](Messenger& m, unsigned own) {
              const Bytes message(101);
              if (own == 1) m.send(Channel::program, 0, message);
              if (own == 0) m.receive(Channel::program, 1, room);
            }),
            kWords);
  EXPECT_EQ(failure_of([&](Messenger& m, unsigned own) {
              const Bytes message(100);
              if (own == 1) m.send(Channel::program, 0, message);
              if (own == 0) m.receive(Channel::program, 1, room);
            }),
            0U)
      << "just enough room";
}

/// What PE 0 calls, and what PE 1: how the run ends.
std::uint32_t failure_of_calls(kit::Call first, kit::Call second) {
  return failure_of([&](Messenger& messenger, unsigned own) {
    messenger.called_together(own == 0 ? first : second);
    if (own == 0) messenger.send(Channel::together, 1, {});
    if (own == 1) messenger.receive(Channel::together, 0, {});
    messenger.end();
  });
}

TEST(Messenger, EndsTheRunWherePesCallSomethingElse) {
  constexpr auto kWords = static_cast<std::uint32_t>(protocol::FaultCode::words);
  using kit::Call;
  EXPECT_EQ(failure_of_calls(Call::barrier(), Call::barrier()), 0U);
  EXPECT_EQ(failure_of_calls(Call::reduce(1, 2, 1), Call::reduce(1, 2, 1)), 0U);
  EXPECT_EQ(failure_of_calls(Call::barrier(), Call::broadcast(0)), kWords);
  EXPECT_EQ(failure_of_calls(Call::broadcast(0), Call::broadcast(1)), kWords);
  EXPECT_EQ(failure_of_calls(Call::broadcast(0xFFEF), Call::broadcast(0xFFEE)), kWords);
  EXPECT_EQ(failure_of_calls(Call::reduce(1, 2, 1), Call::reduce(1, 3, 1)), kWords);
  EXPECT_EQ(failure_of_calls(Call::reduce(1, 2, 1), Call::reduce(1, 2, 2)), kWords);
  EXPECT_EQ(failure_of_calls(Call::reduce(0, 2, 1), Call::all_reduce(2, 1)), kWords);
}

TEST(Messenger, EndsTheRunWhereACallOfOthersIsLeftAtTheEnd) {
  constexpr auto kWords = static_cast<std::uint32_t>(protocol::FaultCode::words);
  const auto left = [](Channel channel) {
    return failure_of([&](Messenger& messenger, unsigned own) {
      messenger.called_together(kit::Call::barrier());
      if (own == 0) messenger.send(channel, 1, {});
      // Of one sender in order: when the second is here, so is the first.
      if (own == 0) messenger.send(Channel::program, 1, {});
      if (own == 1 && channel == Channel::together) messenger.receive(Channel::program, 0, {});
      messenger.end();
    });
  };
  EXPECT_EQ(left(Channel::together), kWords);
  EXPECT_EQ(left(Channel::program), 0U) << "a program may leave messages";
}

TEST(Call, SaysWhatTheProgramSaid) {
  using kit::Call;
  const auto words = [](Call call) {
    kit::Words text;
    return std::string((text << call).text());
  };
  EXPECT_EQ(words(Call::barrier()), "torolux_barrier()");
  EXPECT_EQ(words(Call::broadcast(65519)), "torolux_broadcast(65519, ...)");
  EXPECT_EQ(words(Call::reduce(7, 5, 1).after(Call::broadcast(9))),
            "torolux_reduce(7, ..., TOROLUX_DOUBLE, TOROLUX_MINIMUM)");
  EXPECT_EQ(words(Call::all_reduce(1, 2)), "torolux_all_reduce(..., TOROLUX_UINT32, TOROLUX_MAXIMUM)");
}

TEST(Call, IsAnotherOneNextTime) {
  using kit::Call;
  Call last;
  Call first;
  for (unsigned i = 0; i < 512; ++i) {
    const Call next = Call::barrier().after(last);
    EXPECT_NE(next, last);
    EXPECT_FALSE(next.at_place_of(last));
    EXPECT_TRUE(next.at_place_of(Call::broadcast(0xFFFF).after(last)));
    if (i == 0) first = next;
    last = next;
  }
  EXPECT_EQ(Call::barrier().after(last), first) << "numbers go around";
}

TEST(Messenger, AllThatWaitForEverAreNoticedHere) {
  FakeTorus torus(2, 1, 0, 1);
  Bytes room(1);
  EXPECT_THROW(torus.run([&](FakeNode& node) {
    Messenger messenger(node.niu(), layout());
    messenger.receive(Channel::program, kit::kAnyPe, room);
  }),
               std::logic_error);
}

TEST(SlotLayout, CoversMemoryAsFarAsSlotsHaveNumbers) {
  for (const std::uint32_t bytes : {256U << 10U, 1U << 20U, 4U << 20U, 5U << 20U, 64U << 20U}) {
    const std::uint32_t begin = protocol::kLocalMemoryBase;
    const kit::SlotLayout slots = kit::slot_layout(begin, begin + bytes);
    EXPECT_LE(slots.own + slots.niu, kit::SlotLayout::kMostSlots);
    EXPECT_GE(slots.first, begin);
    EXPECT_EQ(slots.first + (slots.own + slots.niu) * kit::kRecordBytes, begin + bytes);
    EXPECT_EQ(slots.staging, slots.first + (slots.own - kit::kRecordsPerPacket) * kit::kRecordBytes);
  }
}

}  // namespace
}  // namespace torolux::test
