// SPDX-License-Identifier: MIT
// A machine file sets what it names, leaves the rest, and is refused with file and line where it is wrong.
#include "emulator/description/description.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "emulator/errors.hpp"

namespace torolux::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string refusal(const std::string& text) {
  try {
    parse_machine_description(text, "m.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

const std::filesystem::path kDefaultFile =
    std::filesystem::path(TOROLUX_SOURCE_DIR) / "emulator" / "description" / "default.toml";

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(MachineFile, DefaultFileSaysTheBuiltInDefaults) {
  EXPECT_EQ(load_machine_description(kDefaultFile), MachineDescription{});
}

/// The keys that a machine file sets, by reading its lines: "[table]" and "key = value".
std::vector<std::string> keys_in(const std::string& text) {
  std::vector<std::string> keys;
  std::istringstream lines(text);
  std::string table;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("[")) {
      table = line.substr(1, line.find(']') - 1) + ".";
    } else if (!line.empty() && line.front() != '#') {
      keys.push_back(table + line.substr(0, line.find(' ')));
    }
  }
  return keys;
}

TEST(MachineFile, DefaultFileNamesEveryKey) {
  EXPECT_THAT(keys_in(text_of(kDefaultFile)), testing::UnorderedElementsAreArray(machine_description_keys()));
}

TEST(MachineFile, EveryKeyChangesTheDescription) {
  for (const std::string& key : machine_description_keys()) {
    const std::string value = key == "torus.bubble"            ? "false"
                              : key.starts_with("ideal.")      ? "true"
                              : key == "torus.link_error_rate" ? "0.25"
                                                               : "";
    // 17 is no default, and allowed for every other key but the loop limit.
    const std::string text = key + " = " + (!value.empty() ? value : key.ends_with("between_hints") ? "1700" : "17");
    EXPECT_EQ(refusal(text), "") << text;
    EXPECT_NE(parse_machine_description(text, "m.toml"), MachineDescription{}) << text;
  }
}

TEST(MachineFile, SetsWhatItNamesAndNothingElse) {
  const auto machine = parse_machine_description("[processor.latency]\ndivide = 33\n[torus]\nlink_cycles = 5\n", "m");
  MachineDescription expected;
  expected.processor.latency[static_cast<std::size_t>(InstructionClass::divide)] = 33;
  expected.torus.link_cycles = 5;
  EXPECT_EQ(machine, expected);
  EXPECT_EQ(parse_machine_description("", "m"), MachineDescription{});
}

TEST(MachineFile, ErrorsNameFileAndLine) {
  EXPECT_THAT(refusal("\n\n[torus]\nlink_cycels = 1\n"),
              StartsWith("m.toml:4: unknown key 'torus.link_cycels'; did you mean 'torus.link_cycles'?"));
  EXPECT_THAT(refusal("[torus]\nlink_cycels = 1\n"), HasSubstr("may set torus.flit_bytes, torus.router_cycles"));
  EXPECT_THAT(refusal("[touros]\n"), HasSubstr("may set processor.clock_hertz, "));
  EXPECT_THAT(refusal("[touros]\n"), StartsWith("m.toml:1: unknown key 'touros'; did you mean 'torus'?"));
  EXPECT_THAT(refusal("[torus]\nlink_cycles = 0\n"),
              StartsWith("m.toml:2: 'torus.link_cycles' must be a whole number"));
  EXPECT_THAT(refusal("[torus]\nlink_cycles = 0\n"), HasSubstr("from 1 to 1000000"));
  EXPECT_THAT(refusal("[torus]\nlink_cycles = -1\n"), StartsWith("m.toml:2:"));
  EXPECT_THAT(refusal("[torus]\nlink_cycles = 1.5\n"), StartsWith("m.toml:2:"));
  EXPECT_THAT(refusal("[torus]\nlink_cycles = '1'\n"), StartsWith("m.toml:2:"));
  EXPECT_THAT(refusal("[torus]\nlink_cycles = [1]\n"), StartsWith("m.toml:2:"));
  EXPECT_THAT(refusal("[torus]\nbubble = 1\n"), HasSubstr("true or false"));
  EXPECT_THAT(refusal("[torus]\nlink_error_rate = nan\n"), StartsWith("m.toml:2:"));
  EXPECT_THAT(refusal("[torus]\nlink_error_rate = 0.6\n"), StartsWith("m.toml:2:"));
  EXPECT_THAT(refusal("torus = 3\n"), StartsWith("m.toml:1: unknown key 'torus'"));
  EXPECT_THAT(refusal("[torus\nlink_cycles = 1\n"), StartsWith("m.toml:1:"));
  EXPECT_THAT(refusal("[records]\nniu_slots = 99999999999999999999\n"), StartsWith("m.toml:2:"));
  EXPECT_THAT(refusal("[records]\nniu_slots = 4294967296\n"), StartsWith("m.toml:2:"));
}

TEST(MachineValues, OneKeyIsSetAndReadBackExactly) {
  MachineDescription machine;
  set_machine_value(machine, "torus.flit_bytes=32");
  set_machine_value(machine, "torus.link_error_rate=0.1");
  set_machine_value(machine, "torus.bubble=false");
  EXPECT_EQ(machine, parse_machine_description("torus = {flit_bytes=32, link_error_rate=0.1, bubble=false}", "m"));
  MachineDescription again;
  for (const MachineSetting& setting : machine_description_values(machine))
    set_machine_value(again, setting.key + "=" + torolux::text_of(setting.value));
  EXPECT_EQ(again, machine);
  EXPECT_EQ(machine_description_values(machine).size(), machine_description_keys().size());
}

TEST(MachineValues, WhatIsNoKeyOrNoValueIsRefused) {
  MachineDescription machine;
  for (const char* text : {"", "=", "=1", "torus.flit_bytes", "torus.flit_bytes=1\nbus.arbitration_cycles=2",
                           "[torus]\nflit_bytes=1", "torus.flit_bytes=1#", "'torus'.flit_bytes=1"})
    EXPECT_THROW(set_machine_value(machine, text), UsageError) << text;
  for (const char* text : {"torus.flit_bytes=", "torus.flit_bytes=0", "torus.flit_bytes=1.5", "torus.flits=1",
                           "torus=1", "torus.flit_bytes=1 2", "torus.bubble=1"})
    EXPECT_THROW(set_machine_value(machine, text), InputError) << text;
  EXPECT_EQ(machine, MachineDescription{});
}

TEST(MachineFile, AFileThatIsNotThereIsBadInput) {
  EXPECT_THROW(load_machine_description("/nowhere/m.toml"), InputError);
  EXPECT_THROW(load_machine_description("/"), InputError);
}

}  // namespace
}  // namespace torolux::test
