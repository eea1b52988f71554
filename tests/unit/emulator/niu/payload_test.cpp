// SPDX-License-Identifier: MIT
// Proves: between PEs of one process a packet's bytes are gathered once and taken once, and the network hands on where
// they lie; where no place is free, and to PEs elsewhere, they go through the rings, and arrive the same; no place is
// lost, whoever holds it last; what is saved holds them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <thread>
#include <vector>

#include "emulator/engines/engine/shared_memory.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/niu/network_side.hpp"
#include "emulator/niu/processor_side.hpp"
#include "emulator/ranks/content.hpp"
#include "emulator/snapshot/archive.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {
namespace {

using protocol::Hint;

constexpr std::uint32_t kRecordBytes = 64;
constexpr std::uint32_t kSlots = 32;
constexpr std::uint32_t kSlotsAt = 8192;  // in local memory

/// Which kind a record is, its first byte says.
class FirstByte final : public RecordKinds {
 public:
  std::size_t record_kind(std::span<const std::byte> record) const override {
    return std::to_integer<std::size_t>(record[0]);
  }
};

/// A processor without instructions, and its channel.
struct Pe {
  Pe(unsigned number, BlockPool* pool) {
    channel.near = pool != nullptr ? 1 : 0;
    channel.payloads = pool != nullptr ? &pool->payloads() : nullptr;
    network.emplace(channel, number, 2, MachineDescription(), nullptr);
    network->set_slots(kSlots);
    window().slots = {protocol::kLocalMemoryBase + kSlotsAt, kRecordBytes, kSlots, kSlots};
    hint(Hint::set_slots);
    const Command* command = channel.commands.front();
    EXPECT_EQ(command->kind, CommandKind::set_slots);
    channel.commands.pop(*command);
  }
  protocol::NiuWindow& window() { return *reinterpret_cast<protocol::NiuWindow*>(local.data()); }
  std::byte* slot(std::uint32_t number) { return &local[kSlotsAt + number * kRecordBytes]; }
  NiuProcessorSide::Outcome hint(Hint what) {
    const auto result = side.hint(static_cast<std::int32_t>(what), clock + 10, 0);
    clock = result.clock;
    return result.outcome;
  }
  /// The first own slots, filled with bytes from `first` on.
  void send(std::uint32_t records, std::uint8_t first) {
    auto& send = window().send;
    send.destination = 1;
    send.count = static_cast<decltype(send.count)>(records);
    for (std::uint32_t i = 0; i < records; ++i) {
      send.slots[i] = static_cast<std::uint16_t>(i);
      std::memset(slot(i), first + static_cast<int>(i), kRecordBytes);
    }
    ASSERT_EQ(hint(Hint::send_records), NiuProcessorSide::Outcome::done);
  }
  void expect_records(std::uint32_t records, std::uint8_t first) {
    ASSERT_EQ(hint(Hint::receive), NiuProcessorSide::Outcome::done);
    ASSERT_EQ(window().arrival.count, records);
    for (std::uint32_t i = 0; i < records; ++i) {
      const std::byte* const bytes = slot(window().arrival.slots[i]);
      EXPECT_TRUE(std::all_of(bytes, bytes + kRecordBytes, [&](std::byte b) { return b == std::byte(first + i); }));
    }
  }

  SharedMemory memory{"test-channel", niu_channel_bytes()};
  NiuChannel& channel = *niu_channel_at(memory.bytes().data());
  std::vector<std::byte> local = std::vector<std::byte>(64U * 1024U);
  std::optional<NiuNetworkSide> network;
  NiuProcessorSide side{channel, local, 0, NiuProcessorSide::Waiting::returns};
  std::uint64_t clock = 0;
};

struct Network {
  EventQueue events{4};
  PeTimes times{BoundTree(2, kCommandCycles), BoundTree(2, kNever)};
  BlockPool pool;

  /// The next command's block.
  BlockIndex take_from(Pe& pe) {
    pe.network->refresh(events, pool, times);
    const Event event = events.pop();
    EXPECT_EQ(event.kind, EventKind::command);
    return event.block;
  }
  /// Straight there, as if it had crossed the torus.
  void carry(Pe& from, Pe& to) { to.network->deliver(take_from(from), 1, pool, times); }
  /// The pool, and both sides of this PE.
  std::vector<std::byte> saved_with(Pe& pe) {
    return ranks::bytes_of_archive([&](SnapshotWriter& writer) {
      writer(pool);
      pe.network->save(writer);
      pe.network->save_channel(writer);
    });
  }
};

TEST(Payload, StaysWhereItIs) {
  Network network;
  Pe sender(0, &network.pool), receiver(1, &network.pool);
  network.pool.payloads().give_back(network.pool.payloads().take_or_make());
  sender.send(3, 7);
  const Payload* const place = sender.channel.commands.front()->payload;
  ASSERT_NE(place, nullptr);
  EXPECT_EQ(network.pool.payloads().in_use(), 1U);
  network.carry(sender, receiver);
  const Arrival* const arrival = receiver.channel.arrivals.front();
  EXPECT_EQ(arrival->payload, place);
  EXPECT_EQ(arrival->bytes, 0U);
  receiver.expect_records(3, 7);
  EXPECT_EQ(network.pool.payloads().in_use(), 0U);
  EXPECT_EQ(network.pool.in_use(), 0U);
}

TEST(Payload, GoesThroughTheRingWhereNoPlaceIsFree) {
  Network network;
  Pe sender(0, &network.pool), receiver(1, &network.pool);
  ASSERT_EQ(network.pool.payloads().take(), nullptr);
  sender.send(2, 40);
  EXPECT_EQ(sender.channel.commands.front()->payload, nullptr);
  EXPECT_EQ(sender.channel.commands.front()->bytes, 2 * kRecordBytes);
  network.carry(sender, receiver);
  receiver.expect_records(2, 40);
  EXPECT_EQ(network.pool.payloads().in_use(), 0U);
  sender.send(2, 50);  // the network has made places
  EXPECT_NE(sender.channel.commands.front()->payload, nullptr);
}

TEST(Payload, GoesThroughTheRingToAndFromOtherProcesses) {
  Network network;
  Pe near(0, &network.pool), far(1, nullptr);
  network.pool.payloads().give_back(network.pool.payloads().take_or_make());
  near.send(4, 1);
  network.carry(near, far);
  EXPECT_EQ(far.channel.arrivals.front()->payload, nullptr);
  far.expect_records(4, 1);
  far.send(5, 90);
  EXPECT_EQ(far.channel.commands.front()->payload, nullptr);
  network.carry(far, near);
  EXPECT_NE(near.channel.arrivals.front()->payload, nullptr);
  near.expect_records(5, 90);
  EXPECT_EQ(network.pool.payloads().in_use(), 0U);
}

TEST(Payload, OfAFaultyPacketIsNotLost) {
  Network network;
  Pe sender(0, &network.pool);
  network.pool.payloads().give_back(network.pool.payloads().take_or_make());
  sender.window().send.destination = 1;
  sender.window().send.count = 2;
  sender.window().send.slots[0] = 0;
  sender.window().send.slots[1] = 2 * kSlots;
  EXPECT_EQ(sender.hint(Hint::send_records), NiuProcessorSide::Outcome::stop);
  EXPECT_EQ(sender.channel.commands.front()->kind, CommandKind::fault);
  EXPECT_EQ(network.pool.payloads().in_use(), 0U);
}

TEST(Payload, TellsTheKindsOfItsRecords) {
  Network network;
  const FirstByte kinds;
  Pe sender(0, &network.pool);
  sender.channel.record_kinds = &kinds;
  sender.send(3, 13);  // the third is of a kind that has no number in a command
  EXPECT_EQ(sender.channel.commands.front()->kinds, 14U | 15U << 4U);
}

/// A broadcast is one payload for all, until the last has taken it.
TEST(Payload, IsSharedByThoseWhoHearABroadcast) {
  Network network;
  Pe one(0, &network.pool), two(1, &network.pool), far(1, nullptr);
  const BlockIndex block = network.pool.take();
  const std::array<std::byte, 5> contents{std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4}, std::byte{5}};
  network.pool.set_payload(block, contents);
  network.pool.begin_sharing(block);
  for (Pe* pe : {&one, &two, &far}) {
    pe->network->deliver_copy(network.pool[block], 1, network.pool, network.times);
  }
  network.pool.end_sharing(block);
  EXPECT_EQ(one.channel.arrivals.front()->payload, two.channel.arrivals.front()->payload);
  for (Pe* pe : {&one, &two, &far}) {
    EXPECT_EQ(network.pool.payloads().in_use(), pe == &far ? 0U : 1U);
    ASSERT_EQ(pe->hint(Hint::receive), NiuProcessorSide::Outcome::done);
    EXPECT_EQ(pe->window().message.bytes, contents.size());
    EXPECT_TRUE(std::equal(contents.begin(), contents.end(), pe->window().message_bytes.begin()));
  }
}

/// Packets on their way and arrivals that lie in a PE's ring, to a machine whose PEs are near and to one whose are not.
TEST(Payload, IsSavedWithItsHeader) {
  Network network;
  Pe sender(0, &network.pool), receiver(1, &network.pool);
  sender.send(3, 7);
  network.carry(sender, receiver);
  sender.send(2, 9);
  BlockIndex block = network.take_from(sender);
  const std::vector<std::byte> saved = network.saved_with(receiver);
  EXPECT_EQ(sender.hint(Hint::receive), NiuProcessorSide::Outcome::retry);  // all goes on
  receiver.expect_records(3, 7);
  for (const bool near : {true, false}) {
    Network again;
    Pe restored(1, near ? &again.pool : nullptr);
    std::size_t at = 0;
    SnapshotReader reader([&](std::span<std::byte> bytes) {
      ASSERT_LE(at + bytes.size(), saved.size());
      std::copy_n(saved.begin() + static_cast<std::ptrdiff_t>(at), bytes.size(), bytes.begin());
      at += bytes.size();
    });
    reader(again.pool);
    restored.network->restore(reader, again.pool);
    EXPECT_EQ(at, saved.size());
    EXPECT_EQ(restored.channel.arrivals.front()->payload != nullptr, near);
    restored.clock = receiver.clock;
    restored.expect_records(3, 7);
    restored.network->deliver(block, 200, again.pool, again.times);
    restored.expect_records(2, 9);
    EXPECT_EQ(again.pool.payloads().in_use(), 0U);
  }
}

/// A near PE's ring holds headers alone: more of them than have room with their payloads in another's. Those wait, in
/// their order, and nothing behind the first of them counts as known.
TEST(Payload, WaitsWhereARingHasNoRoomWhenGoingOn) {
  constexpr std::uint8_t packets = 200;
  constexpr std::uint32_t records = 12;
  static_assert(packets * records * kRecordBytes > kMostRingBytes && records * kRecordBytes <= kMostBlockBytes);
  Network network;
  Pe receiver(1, &network.pool);
  for (std::uint8_t i = 0; i < packets; ++i) {
    const BlockIndex block = network.pool.take();
    network.pool[block].records = records;
    network.pool.set_payload(block, std::vector<std::byte>(std::size_t{records} * kRecordBytes, std::byte(i)));
    receiver.network->deliver(block, 1U + i, network.pool, network.times);
  }
  receiver.network->publish_horizon(1000);
  const std::vector<std::byte> saved = network.saved_with(receiver);
  Network again;
  Pe restored(1, nullptr);
  ranks::read_archive(saved, [&](SnapshotReader& reader) {
    reader(again.pool);
    restored.network->restore(reader, again.pool);
  });
  EXPECT_LE(restored.channel.horizon.load(), packets);
  std::uint8_t taken = 0;
  while (const Arrival* arrival = restored.channel.arrivals.front()) {
    EXPECT_EQ(arrival->time, 1U + taken);
    EXPECT_EQ(contents_of(*arrival)[0], std::byte(taken));
    restored.channel.arrivals.pop(*arrival);
    ++taken;
    restored.network->refresh(again.events, again.pool, again.times);
  }
  EXPECT_EQ(taken, packets);
  EXPECT_EQ(again.pool.payloads().in_use(), 0U);
}

TEST(PayloadPool, ServesManyThreads) {
  PayloadPool pool;
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < 4; ++i) {
    threads.emplace_back([&pool, i] {
      for (unsigned round = 0; round < 2000; ++round) {
        std::array<Payload*, 40> held{};
        for (Payload*& one : held) {
          one = round % 8 == 0 ? pool.take_or_make() : pool.take();
          if (one != nullptr) one->bytes.fill(std::byte(i));
        }
        for (Payload* const one : held) {
          if (one == nullptr) continue;
          ASSERT_EQ(one->bytes[17], std::byte(i));
          pool.give_back(one);
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(pool.in_use(), 0U);
}

}  // namespace
}  // namespace torolux
