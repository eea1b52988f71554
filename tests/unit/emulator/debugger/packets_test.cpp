// SPDX-License-Identifier: MIT
// Proves: packets survive their frame and any cut into pieces; damaged and hostile bytes are told from packets and
// crash nothing; what requests say is read, and what they cannot say is refused.
#include <gtest/gtest.h>

#include <random>

#include "emulator/debugger/packets.hpp"
#include "emulator/debugger/registers.hpp"
#include "emulator/debugger/requests.hpp"
#include "emulator/debugger/stop.hpp"
#include "emulator/debugger/words.hpp"

namespace torolux::debugger {
namespace {

using Item = PacketReader::Item;

std::string random_text(std::mt19937& random, std::size_t longest) {
  std::string text(random() % longest, ' ');
  for (char& c : text) c = static_cast<char>(random());
  return text;
}

TEST(DebuggerPackets, AnyContentsComeBack) {
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    const std::string contents = random_text(random, 200);
    std::string bytes = framed(contents);
    EXPECT_EQ(bytes.find_first_of("#$", 1), bytes.size() - 3);
    PacketReader reader;
    while (!bytes.empty()) {
      EXPECT_FALSE(reader.next());
      const std::size_t piece = 1 + random() % bytes.size();
      reader.take(bytes.substr(0, piece));
      bytes.erase(0, piece);
    }
    const auto item = reader.next();
    ASSERT_TRUE(item);
    EXPECT_EQ(item->kind, Item::Kind::packet);
    EXPECT_EQ(item->contents, contents);
    EXPECT_FALSE(reader.next());
  }
}

TEST(DebuggerPackets, WhatIsNoPacketIsToldFromOne) {
  PacketReader reader;
  reader.take("++$g#66-\x03$g#67$g#zz");
  using enum Item::Kind;
  for (const Item::Kind kind : {damaged, repeat, interrupt, packet, damaged}) {
    const auto item = reader.next();
    ASSERT_TRUE(item);
    EXPECT_EQ(item->kind, kind);
  }
  EXPECT_FALSE(reader.next());
}

TEST(DebuggerPackets, OneWithoutAnEndTakesNoMemory) {
  PacketReader reader;
  bool damaged = false;
  for (int i = 0; i < 100; ++i) {
    reader.take("$" + std::string(1000, 'a'));
    while (const auto item = reader.next()) damaged |= item->kind == Item::Kind::damaged;
  }
  EXPECT_TRUE(damaged);
  reader.take("#00$?#3f");
  std::string last;
  while (const auto item = reader.next()) last = item->contents;
  EXPECT_EQ(last, "?");
}

TEST(DebuggerPackets, HostileBytesCrashNothing) {
  const std::string pieces[] = {"vCont", ";c:p1.1", "p-1.-1", "Z0,", "80000000", ",", ":",
                                ";",     "=",       "-",      "$",   "#",        "}"};
  std::mt19937 random(2);
  for (int i = 0; i < 20'000; ++i) {
    std::string bytes;
    for (std::size_t piece = random() % 8; piece > 0; --piece) {
      bytes += random() % 3 == 0 ? random_text(random, 12) : pieces[random() % std::size(pieces)];
    }
    PacketReader reader;
    reader.take(bytes);
    while (reader.next()) {
    }
    EXPECT_FALSE(resume_actions(bytes).value_or(std::vector<ResumeAction>(1)).empty());
    thread_choice(bytes);
    process_in(bytes);
    memory_range(bytes);
    point_in(bytes);
    PeRegisters registers{};
    set_register(registers, static_cast<unsigned>(random() % 100), bytes);
    const auto read = bytes_in(bytes);
    EXPECT_TRUE(!read || hex_of(*read).size() == bytes.size());
  }
}

TEST(DebuggerRequests, ThreadsAreRead) {
  using enum ThreadChoice::Kind;
  EXPECT_EQ(thread_choice("p3.1"), (ThreadChoice{one, 2}));
  EXPECT_EQ(thread_choice("p3.-1"), (ThreadChoice{one, 2}));
  EXPECT_EQ(thread_choice("p1f"), (ThreadChoice{one, 30}));
  EXPECT_EQ(thread_choice("-1"), ThreadChoice{all});
  EXPECT_EQ(thread_choice("p-1.-1"), ThreadChoice{all});
  EXPECT_EQ(thread_choice("0"), ThreadChoice{any});
  EXPECT_EQ(thread_choice("p0.0"), ThreadChoice{any});
  for (const char* wrong : {"", "p", "p3.2", "q1", "p1.x", "1.1", "-2"}) EXPECT_FALSE(thread_choice(wrong)) << wrong;
}

TEST(DebuggerRequests, ResumptionsAreRead) {
  const auto actions = resume_actions(";s:p2.1;r80000000,80000010:p1.1;c");
  ASSERT_TRUE(actions);
  ASSERT_EQ(actions->size(), 3U);
  EXPECT_EQ((*actions)[0].how.kind, Resumption::Kind::steps);
  EXPECT_TRUE((*actions)[0].who.holds(1));
  EXPECT_FALSE((*actions)[0].who.holds(0));
  EXPECT_EQ((*actions)[1].how, (Resumption{Resumption::Kind::in_range, 0x8000'0000, 0x8000'0010}));
  EXPECT_TRUE((*actions)[2].who.holds(77));
  for (const char* wrong : {"", ";", "c", ";x", ";c:", ";c:p1.7", ";r1", ";r1,", ";t"}) {
    if (std::string_view(wrong) == ";c:") continue;  // as ";c"
    EXPECT_FALSE(resume_actions(wrong)) << wrong;
  }
}

TEST(DebuggerRequests, PointsAreRead) {
  EXPECT_EQ(point_in("0,80000004,2"), (Point{PointKind::breakpoint, 0x8000'0004, 0}));
  EXPECT_EQ(point_in("2,80000004,4"), (Point{PointKind::write, 0x8000'0004, 4}));
  EXPECT_EQ(point_in("4,80000004,8;X1,0"), (Point{PointKind::access, 0x8000'0004, 8}));
  for (const char* wrong : {"", "5,1,1", "0", "0,", "0,1", "00,1,1", "0,123456789,1"})
    EXPECT_FALSE(point_in(wrong)) << wrong;
}

TEST(DebuggerRegisters, EachIsReadAndSetByItsNumber) {
  PeRegisters registers{};
  registers.clock = 0x1'0000'0002;
  unsigned number = 0, wide = 0;
  for (; const auto text = register_text(registers, number); ++number) {
    if (text->size() != 8) {
      ++wide;
      EXPECT_FALSE(set_register(registers, number, "00000000"));
      continue;
    }
    ASSERT_TRUE(set_register(registers, number, "1e000000"));
    const bool always_zero = number == 0;
    EXPECT_NE(*register_text(registers, number) == "00000000", !always_zero) << number;
  }
  EXPECT_EQ(wide, 2U);
  EXPECT_EQ(registers.pc, 0x1EU);
  EXPECT_FALSE(set_register(registers, number, "00000000"));
  std::size_t entries = 0;
  const std::string xml = target_description();
  for (std::size_t at = xml.find("<reg "); at != std::string::npos; at = xml.find("<reg ", at + 1)) ++entries;
  EXPECT_EQ(entries, number);
}

TEST(DebuggerStops, RepliesNameThreadAndReason) {
  EXPECT_EQ(stop_reply({.reason = Stop::Reason::breakpoint, .pe = 2}, true), "T05thread:p3.1;swbreak:;");
  EXPECT_EQ(stop_reply({.reason = Stop::Reason::breakpoint, .pe = 2}, false), "T05thread:p3.1;");
  EXPECT_EQ(stop_reply({.reason = Stop::Reason::watch, .pe = 0, .watch = PointKind::read, .address = 0x80001000}, true),
            "T05thread:p1.1;rwatch:80001000;");
  EXPECT_EQ(stop_reply({.reason = Stop::Reason::trap, .pe = 0, .cause = 5}, true), "T0bthread:p1.1;");
  EXPECT_EQ(stop_reply({.reason = Stop::Reason::past_begins, .pe = 0}, true), "T05thread:p1.1;replaylog:begin;");
}

}  // namespace
}  // namespace torolux::debugger
