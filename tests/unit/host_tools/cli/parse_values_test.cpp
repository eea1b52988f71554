// SPDX-License-Identifier: MIT
// Proves: values are read as documented; wrong form is a usage error, a value that is not allowed is bad input.
#include "host_tools/cli/parse_values.hpp"

#include <gmock/gmock.h>

#include "emulator/errors.hpp"
#include "host_tools/settings/scheme.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing_support::message_of;

TEST(ParsePair, TakesTwoNumbers) {
  EXPECT_EQ(parse_pair("640x480", 1, 1000), (std::array<std::uint32_t, 2>{640, 480}));
}

TEST(ParsePair, RefusesWrongForms) {
  for (const char* text : {"", "640", "640x", "x480", "640x480x1", "640X480", "-1x4", "+1x4", "1.5x4", " 1x4", "1x4 "})
    EXPECT_THROW(parse_pair(text, 1, 1000), UsageError) << text;
}

TEST(ParsePair, RefusesValuesOutOfRange) {
  for (const char* text : {"0x4", "4x0", "1001x4", "4x99999999999999999999999"})
    EXPECT_THAT(message_of<InputError>([&] { parse_pair(text, 1, 1000); }), HasSubstr("1 to 1000")) << text;
}

TEST(ParsePes, AtMostAsManyAsHaveNumbers) {
  EXPECT_EQ(parse_pes("3x5"), (std::array<std::uint32_t, 2>{3, 5}));
  EXPECT_EQ(parse_pes("65520x1"), (std::array<std::uint32_t, 2>{65520, 1}));
  EXPECT_THROW(parse_pes("0x4"), InputError);
  EXPECT_THROW(parse_pes("256x256"), InputError);
  EXPECT_THROW(parse_pes("4"), UsageError);
}

TEST(ParseSubspaces, TakesThreeNumbersOrAuto) {
  EXPECT_EQ(parse_subspaces("8x4x2"), (std::array<std::uint32_t, 3>{8, 4, 2}));
  EXPECT_EQ(parse_subspaces("auto"), std::nullopt);
  EXPECT_EQ(parse_fraction("auto"), std::nullopt);
  EXPECT_EQ(parse_fraction("0.25"), 0.25);
  EXPECT_THROW(parse_fraction("1.5"), InputError);
  EXPECT_THROW(parse_fraction("half"), UsageError);
  EXPECT_THROW(parse_subspaces("8x8"), UsageError);
  EXPECT_THROW(parse_subspaces("8x0x8"), InputError);
}

TEST(ParseMemory, TakesUnits) {
  EXPECT_EQ(parse_memory("512K"), 512U * 1024U);
  EXPECT_EQ(parse_memory("64M"), 64U * 1024U * 1024U);
  EXPECT_EQ(parse_memory("262144"), 262144U);
  for (const char* text : {"", "K", "1G", "1.5M", "-1M", "1 M"}) EXPECT_THROW(parse_memory(text), UsageError) << text;
  for (const char* text : {"0", "255K", "65M", "262145", "99999999999999999999M", "17592186044417M"})
    EXPECT_THROW(parse_memory(text), InputError) << text;
}

TEST(ParsePeList, TakesNumbersAndRanges) {
  EXPECT_EQ(parse_pe_list("3"), std::vector<unsigned>{3});
  EXPECT_EQ(parse_pe_list("7,0-3,2"), (std::vector<unsigned>{0, 1, 2, 3, 7}));
  for (const char* text : {"", ",", "3,", "1-2-3", "-3", "3-", "a", "1..3", "0x3", " 3"})
    EXPECT_THROW(parse_pe_list(text), UsageError) << text;
  for (const char* text : {"3-1", "65520", "0-99999999999999999999"})
    EXPECT_THROW(parse_pe_list(text), InputError) << text;
}

TEST(ParseGdbEndpoint, TakesPeAndPort) {
  EXPECT_EQ(parse_gdb_endpoint("3:1234"), (GdbEndpoint{3, 1234}));
  EXPECT_EQ(parse_gdb_endpoint("0:0"), (GdbEndpoint{0, 0}));
  EXPECT_EQ(parse_gdb_endpoint("7:/tmp/a:b"), (GdbEndpoint{7, 0, "/tmp/a:b"}));
  EXPECT_EQ(parse_gdb_endpoint("7:./pe7"), (GdbEndpoint{7, 0, "./pe7"}));
  for (const char* text :
       {"", "3", "3:", ":1234", "3:1:2", "a:1", "3:-1", "localhost:1234", "3:pe3", "/tmp/pe3", "x:/tmp/pe3"})
    EXPECT_THROW(parse_gdb_endpoint(text), UsageError) << text;
  for (const char* text : {"3:65536", "65520:1234"}) EXPECT_THROW(parse_gdb_endpoint(text), InputError) << text;
}

TEST(ParseVector, TakesThreeNumbers) {
  EXPECT_EQ(parse_vector("1,-2.5,3e2"), (std::array<double, 3>{1, -2.5, 300}));
  EXPECT_EQ(parse_vector("-.5,+1,0"), (std::array<double, 3>{-0.5, 1, 0}));
  for (const char* text : {"", "1,2", "1,2,3,4", "1,,3", "1,2,x", "nan,0,0", "inf,0,0", "1e999,0,0", "1, 2,3"})
    EXPECT_THROW(parse_vector(text), UsageError) << text;
}

TEST(ParseLength, TakesALengthOrAuto) {
  EXPECT_EQ(parse_length("0.25"), 0.25);
  EXPECT_EQ(parse_length("auto"), std::nullopt);
  EXPECT_THROW(parse_length("long"), UsageError);
  EXPECT_THROW(parse_length("0"), InputError);
  EXPECT_THROW(parse_length("-1"), InputError);
}

TEST(ParseNumber, HasLimits) {
  EXPECT_EQ(parse_number("1e-2", 0, 1), 0.01);
  EXPECT_THROW(parse_number("2", 0, 1), InputError);
  EXPECT_THROW(parse_number("one", 0, 1), UsageError);
  EXPECT_THROW(parse_number("nan", 0, 1), UsageError);
}

TEST(ParseName, GivesItsNumber) {
  EXPECT_EQ(parse_name("spread", kSchemeNames, "no scheme"), 0U);
  EXPECT_EQ(parse_name("paper", kSchemeNames, "no scheme"), 1U);
  for (const char* text : {"", "Paper", "paper "})
    EXPECT_THAT(message_of<UsageError>([&] { parse_name(text, kSchemeNames, "no scheme"); }),
                AllOf(HasSubstr("no scheme"), HasSubstr("spread, paper")));
}

TEST(ParseLayers, TakesNamesOrAll) {
  using protocol::Plane;
  EXPECT_EQ(parse_layers("depth"), protocol::plane_bit(Plane::depth));
  EXPECT_EQ(parse_layers("owner,depth,owner"), protocol::plane_bit(Plane::depth) | protocol::plane_bit(Plane::owner));
  EXPECT_EQ(parse_layers("all"), (1U << protocol::kPlanes) - 2U) << "all but the colours";
  for (const char* text : {"", "colour", "depth,", "depth, cost", "all,depth"})
    EXPECT_THROW(parse_layers(text), UsageError) << text;
}

TEST(ParseLinkFault, IsAChanceUpToHalf) {
  EXPECT_EQ(parse_link_fault("link:0.25"), 0.25);
  EXPECT_EQ(parse_link_fault("link:0"), 0);
  EXPECT_THROW(parse_link_fault("0.25"), UsageError);
  EXPECT_THROW(parse_link_fault("link:"), UsageError);
  EXPECT_THROW(parse_link_fault("link:0.51"), InputError);
  EXPECT_THROW(parse_link_fault("link:-0.1"), InputError);
}

TEST(ParseRates, AreAboveZeroAndAtMostOne) {
  EXPECT_EQ(parse_rates("0.1,1"), (std::vector<double>{0.1, 1}));
  EXPECT_THROW(parse_rates(""), UsageError);
  EXPECT_THROW(parse_rates("0.1,"), UsageError);
  EXPECT_THROW(parse_rates("0.1,0"), InputError);
  EXPECT_THROW(parse_rates("1.01"), InputError);
}

TEST(ParseCount, HasLimits) {
  EXPECT_EQ(parse_count("18446744073709551615", 0, ~std::uint64_t{0}), ~std::uint64_t{0});
  EXPECT_EQ(parse_count("0018446744073709551615", 0, ~std::uint64_t{0}), ~std::uint64_t{0});
  for (const char* text : {"18446744073709551616", "99918446744073709551615", "-18446744073709551615"})
    EXPECT_THROW(parse_count(text, 0, ~std::uint64_t{0}), InputError) << text;
  EXPECT_EQ(parse_count("7", 1, 7), 7U);
  EXPECT_THROW(parse_count("8", 1, 7), InputError);
  EXPECT_THROW(parse_count("0", 1, 7), InputError);
  EXPECT_THROW(parse_count("-3", 1, 7), InputError);
  for (const char* text : {"", "-", "3.0", "0x7", "seven"}) EXPECT_THROW(parse_count(text, 1, 7), UsageError) << text;
}

}  // namespace
}  // namespace torolux
