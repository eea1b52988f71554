// SPDX-License-Identifier: MIT
// Proves: a run that is slowed down keeps virtual time to the speed asked for; a step lets exactly one more event,
// packet or round pass; packets are where their last hop has them, and go when they have left; nonsense is refused.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <vector>

#include "emulator/errors.hpp"
#include "emulator/torus/shape.hpp"
#include "host_tools/display/pace.hpp"

namespace torolux::test {
namespace {

using Json = nlohmann::json;
using Seconds = std::chrono::duration<double>;

Pace::Clock::time_point at(double seconds) {
  return Pace::Clock::time_point(std::chrono::duration_cast<Pace::Clock::duration>(Seconds(1000 + seconds)));
}

struct Packets {
  PacketsHeader header{};
  std::vector<PacketPlace> places;
};

Packets packets_of(Pace& pace) {
  const std::string contents = pace.packets();
  Packets packets;
  std::memcpy(&packets.header, contents.data(), sizeof packets.header);
  packets.places.resize(packets.header.packets);
  EXPECT_EQ(contents.size(), sizeof packets.header + packets.places.size() * sizeof(PacketPlace));
  if (!packets.places.empty()) {
    std::memcpy(packets.places.data(), contents.data() + sizeof packets.header,
                packets.places.size() * sizeof(PacketPlace));
  }
  return packets;
}

Block packet(std::uint64_t number) {
  Block block{};
  block.number = number;
  block.source = 1;
  block.destination = 6;
  block.records = 3;
  return block;
}

TEST(Pace, KeepsVirtualTimeToTheSpeed) {
  Pace pace;
  EXPECT_TRUE(pace.lets(5000)) << "nobody holds it back";
  pace.obey({{"speed", 100}}, at(0));
  EXPECT_FALSE(pace.lets(5100, at(0.99)));
  EXPECT_TRUE(pace.lets(5100, at(1)));
  EXPECT_TRUE(pace.lets(5100, at(1))) << "all events of that time";
  EXPECT_FALSE(pace.lets(5201, at(2)));
  pace.obey({{"speed", 1000}}, at(2));
  EXPECT_TRUE(pace.lets(5201, at(2.01))) << "from where it was";
  pace.obey({{"speed", 0}}, at(3));
  EXPECT_FALSE(pace.lets(5202, at(1e6)));
  pace.obey({{"speed", "free"}}, at(4));
  EXPECT_TRUE(pace.lets(1'000'000'000));
}

TEST(Pace, AStepLetsOneMorePass) {
  Pace pace;
  pace.stand();
  EXPECT_FALSE(pace.lets(1, at(0)));
  pace.obey({{"step", "event"}}, at(0));
  EXPECT_TRUE(pace.lets(1, at(0)));
  EXPECT_FALSE(pace.lets(2, at(9)));
  for (const auto& [name, step, other] :
       {std::tuple{"packet", Step::packet, Step::round}, std::tuple{"round", Step::round, Step::packet}}) {
    pace.obey({{"step", name}}, at(10));
    EXPECT_TRUE(pace.lets(3, at(10)));
    pace.passed(other);
    EXPECT_TRUE(pace.lets(4, at(10)));
    pace.passed(step);
    EXPECT_FALSE(pace.lets(5, at(10))) << name;
  }
}

TEST(Pace, KnowsWherePacketsAre) {
  Pace pace;
  pace.stand();
  const Block one = packet(77);
  pace.entered(1, one);
  Packets seen = packets_of(pace);
  ASSERT_EQ(seen.places.size(), 1U);
  EXPECT_EQ(seen.header.cycles_per_second, 0);
  EXPECT_EQ(seen.places[0].way, PacketPlace::kWaits);
  EXPECT_EQ(seen.places[0].router, 1);
  EXPECT_EQ(seen.places[0].records, 3);
  pace.leaves(1, index_of(Port::south), one, 100, 110);
  const auto step_to = [&pace](Cycles time) {
    pace.obey({{"step", "event"}}, at(0));
    EXPECT_TRUE(pace.lets(time, at(0)));
  };
  step_to(104);
  seen = packets_of(pace);
  EXPECT_EQ(seen.header.present, 104U);
  EXPECT_EQ(seen.places.at(0).way, static_cast<std::uint8_t>(Port::south));
  EXPECT_EQ(seen.places.at(0).part, 102) << "four tenths of the way";
  pace.leaves(5, index_of(Port::local), one, 112, 130);
  step_to(130);
  EXPECT_EQ(packets_of(pace).places.at(0).part, 255);
  step_to(131);
  EXPECT_TRUE(packets_of(pace).places.empty()) << "it has arrived";
  pace.go_free();
  pace.entered(1, one);
  seen = packets_of(pace);
  EXPECT_TRUE(seen.places.empty()) << "at full speed nobody follows them";
  EXPECT_LT(seen.header.cycles_per_second, 0);
}

TEST(Pace, RefusesWhatItCannotDo) {
  Pace pace;
  for (const Json& values :
       {Json{{"speed", -1}}, Json{{"speed", "fast"}}, Json{{"speed", 1e300}}, Json{{"step", "mile"}}, Json{{"step", 3}},
        Json{{"do", "pace"}}, Json{{"speed", nullptr}}}) {
    EXPECT_THROW(pace.obey(values, at(0)), InputError) << values;
    EXPECT_TRUE(pace.is_free()) << values;
  }
}

}  // namespace
}  // namespace torolux::test
