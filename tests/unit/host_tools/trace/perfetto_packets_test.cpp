// SPDX-License-Identifier: MIT
// Proves: the bytes of messages and packets are those that a hand makes of the public description of the format.
#include <gtest/gtest.h>

#include <array>

#include "host_tools/trace/perfetto_packets.hpp"
#include "tests/support/trace_reader.hpp"

namespace torolux {
namespace {

using testing_support::read_trace;
using testing_support::ReadEvent;

std::string bytes(std::initializer_list<int> values) {
  std::string result;
  for (const int value : values) result.push_back(static_cast<char>(value));
  return result;
}

TEST(Protobuf, FieldsAreEncodedAsDescribed) {
  // 150 in field 1, and "testing" in field 2: the examples of the description.
  EXPECT_EQ(ProtoMessage().varint(1, 150).bytes(), bytes({0x08, 0x96, 0x01}));
  EXPECT_EQ(ProtoMessage().text(2, "testing").bytes(), bytes({0x12, 7, 't', 'e', 's', 't', 'i', 'n', 'g'}));
  EXPECT_EQ(ProtoMessage().varint(60, 0).bytes(), bytes({0xE0, 0x03, 0}));
  EXPECT_EQ(ProtoMessage().varint(1, ~std::uint64_t{0}).bytes(),
            bytes({0x08, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x01}));
  EXPECT_EQ(ProtoMessage().fixed64(47, 0x0102030405060708).bytes(), bytes({0xF9, 0x02, 8, 7, 6, 5, 4, 3, 2, 1}));
  EXPECT_EQ(ProtoMessage().real(44, 1.0).bytes(), bytes({0xE1, 0x02, 0, 0, 0, 0, 0, 0, 0xF0, 0x3F}));
  EXPECT_EQ(ProtoMessage().message(3, ProtoMessage().varint(1, 150)).bytes(), bytes({0x1A, 3, 0x08, 0x96, 0x01}));
}

TEST(PerfettoPackets, ASliceIsTwoPacketsWithTheNumberOfItsName) {
  std::string trace;
  PerfettoPackets packets([&](std::string_view more) { trace += more; });
  packets.make_track(2, 0, "A", 5);
  packets.slice(2, 300, 301, packets.name("b"));
  EXPECT_EQ(trace, "");  // it comes in large pieces
  packets.flush();
  const std::string track = bytes({0x0A, 16, 0xE2, 0x03, 9, 0x08, 2, 0x12, 1, 'A', 0x58, 3, 0x60, 5, 0x50, 1, 0x68, 3});
  const std::string name = bytes({0x0A, 13, 0x62, 7, 0x12, 5, 0x08, 1, 0x12, 1, 'b', 0x50, 1, 0x68, 2});
  const std::string begin = bytes({0x0A, 15, 0x40, 0xAC, 0x02, 0x5A, 6, 0x48, 1, 0x58, 2, 0x50, 1, 0x50, 1, 0x68, 2});
  const std::string end = bytes({0x0A, 13, 0x40, 0xAD, 0x02, 0x5A, 4, 0x48, 2, 0x58, 2, 0x50, 1, 0x68, 2});
  EXPECT_EQ(trace, track + name + begin + end);
  EXPECT_EQ(packets.bytes(), trace.size());
}

TEST(PerfettoPackets, WhatIsWrittenIsRead) {
  std::string trace;
  PerfettoPackets packets([&](std::string_view more) { trace += more; });
  packets.make_track(7, 0, "group", 0);
  packets.make_track(8, 7, "lane", 0);
  packets.make_counter(9, 8, "load", "%", 1);
  const std::array<Annotation, 1> annotations = {{{"to", "PE 3"}}};
  packets.arrow(8, 10, "sent", 1234567890123, ArrowEnd::begins, annotations);
  packets.counter(9, 11, std::uint64_t{42});
  packets.counter(9, 12, 0.25);
  packets.arrow(8, 13, "received", 1234567890123, ArrowEnd::ends, {});
  packets.instant(8, 14, "end", {});
  packets.flush();
  const auto read = read_trace(trace);
  EXPECT_EQ(read.wrong, std::vector<std::string>());
  ASSERT_EQ(read.events.size(), 5U);
  EXPECT_EQ(read.tracks.at(9).unit, "%");
  EXPECT_EQ(read.tracks.at(9).parent, 8U);
  EXPECT_EQ(read.events[0].name, "sent");
  EXPECT_EQ(read.events[0].annotations.at("to"), "PE 3");
  EXPECT_EQ(read.events[1].value, 42);
  EXPECT_EQ(read.events[2].value, 0.25);
  EXPECT_EQ(read.events[3].arrow_ends, std::vector<std::uint64_t>{1234567890123});
  EXPECT_EQ(read.events[4].type, ReadEvent::instant);
}

}  // namespace
}  // namespace torolux
