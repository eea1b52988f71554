// SPDX-License-Identifier: MIT
// Names of phases: what is taken, what is refused and why, in a section alone and in an ELF file.
#include "emulator/engines/image/phase_records.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "emulator/engines/image/image_set.hpp"
#include "emulator/errors.hpp"
#include "tests/unit/emulator/engines/elf_builder.hpp"

namespace torolux::test {
namespace {

using testing::HasSubstr;

void put_record(std::vector<std::byte>& section, std::uint32_t phase, const std::string& name) {
  const std::size_t at = section.size();
  section.resize(at + kPhaseRecordBytes);
  std::memcpy(section.data() + at, &phase, sizeof phase);
  std::memcpy(section.data() + at + sizeof phase, name.data(), std::min<std::size_t>(name.size(), 24));
}

std::string wrong_with(std::uint32_t phase, const std::string& name) {
  std::vector<std::byte> section;
  put_record(section, 9, "first");
  put_record(section, phase, name);
  return read_phase_records(section).wrong;
}

TEST(PhaseRecords, GiveNamesByNumber) {
  std::vector<std::byte> section;
  put_record(section, 15, "multiply, add");
  put_record(section, 9, "r\u00fccken");
  put_record(section, 0, std::string(kMostPhaseNameBytes, 'x'));
  const PhaseRecords records = read_phase_records(section);
  EXPECT_EQ(records.wrong, "");
  EXPECT_EQ(records.names[15], "multiply, add");
  EXPECT_EQ(records.names[9], "r\u00fccken");
  EXPECT_EQ(records.names[0].size(), kMostPhaseNameBytes);
  EXPECT_EQ(records.names[8], "program") << "start-up code enters it";
  EXPECT_EQ(records.names[1], "") << "not those of Torolux";
  EXPECT_EQ(phase_name(records.names, 1), "phase_1");
}

TEST(PhaseRecords, SayWhatIsWrong) {
  EXPECT_THAT(wrong_with(16, "x"), HasSubstr("names phase 16; there are 0 to 15"));
  // What a program in C has written.
  EXPECT_THAT(wrong_with(16, "x"), HasSubstr("in C it is TOROLUX_PHASE_NAME(7, ...), of 0 to 6"));
  EXPECT_THAT(wrong_with(10, ""), HasSubstr("in C it is TOROLUX_PHASE_NAME(1, ...)"));
  EXPECT_THAT(wrong_with(0xFFFF'FFFFU, "x"), HasSubstr("4294967295"));
  EXPECT_THAT(wrong_with(10, std::string(24, 'x')), HasSubstr("longer than 23 bytes"));
  EXPECT_THAT(wrong_with(10, ""), HasSubstr("empty name of phase 10"));
  EXPECT_THAT(wrong_with(9, "second"), HasSubstr("phase 9 twice: \"first\" and \"second\""));
  EXPECT_THAT(wrong_with(10, "first"), HasSubstr("calls two phases \"first\""));
  EXPECT_THAT(wrong_with(10, "outside"), HasSubstr("take another name"));
  EXPECT_THAT(wrong_with(10, "program"), HasSubstr("as start-up code calls phase 8"));
  for (const char* text : {"a\nb", "\x7f", "\x80", "\xc2\x85", "\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80",
                           "\xf4\x90\x80\x80", "\xc3", "a\xe2\x82", "\xff"})
    EXPECT_THAT(wrong_with(10, text), HasSubstr("no UTF-8")) << text;
  for (const char* text : {"a b", "\u00a0", "\u20ac", "\U0001f600"}) EXPECT_EQ(wrong_with(10, text), "") << text;
  std::vector<std::byte> section;
  put_record(section, 9, "cut");
  section.pop_back();
  EXPECT_THAT(read_phase_records(section).wrong, HasSubstr("27 bytes"));
}

TEST(PhaseRecords, HoldForAnyBytes) {
  std::mt19937 random(17);
  for (int i = 0; i < 20000; ++i) {
    std::vector<std::byte> section;
    for (auto n = random() % 4; n > 0; --n) {
      std::string name(random() % 25, 'a');
      for (char& c : name) c = random() % 3 == 0 ? static_cast<char>(random()) : 'b';
      put_record(section, static_cast<std::uint32_t>(random() % 18), name);
    }
    const PhaseRecords records = read_phase_records(section);
    for (const std::string& name : records.names) {
      EXPECT_LE(name.size(), kMostPhaseNameBytes);
      EXPECT_EQ(name.find('\0'), std::string::npos);
    }
  }
}

std::vector<std::byte> elf_with(const std::vector<std::byte>& phases) {
  ElfPlan plan;
  plan.code = {0x13, 0x13};
  plan.phases = phases;
  return build_elf(plan);
}

TEST(PhaseNamesOfAnImage, ComeFromItsSection) {
  std::vector<std::byte> phases;
  put_record(phases, 9, "multiply");
  const Image image = parse_image(elf_with(phases), "image.elf");
  EXPECT_EQ(image.phase_names[9], "multiply");
  EXPECT_EQ(image.phase_names[0], "");
  ElfPlan without;
  without.code = {0x13};
  EXPECT_EQ(parse_image(build_elf(without), "image.elf").phase_names, built_in_phase_names());
}

TEST(PhaseNamesOfAnImage, OfSeveralImagesStandTogether) {
  Image a, b;
  a.phase_names = {};
  a.phase_names[9] = "multiply";
  a.phase_names[10] = "shift";
  b.phase_names = a.phase_names;
  b.phase_names[9] = "shift";
  b.phase_names[10] = "";
  b.phase_names[11] = "shift";
  const PhaseNames names = ImageSet({a, b, a}, {0, 1, 2}).phase_names();
  EXPECT_EQ(names[9], "multiply / shift");
  EXPECT_EQ(names[10], "shift");
  EXPECT_EQ(names[11], "shift (phase 11)");
  EXPECT_EQ(names[12], "");
  EXPECT_EQ(ImageSet(a).phase_names(), a.phase_names);
}

TEST(PhaseNamesOfAnImage, AreRefusedWithTheFile) {
  std::vector<std::byte> phases;
  put_record(phases, 77, "x");
  try {
    parse_image(elf_with(phases), "image.elf");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("image.elf: names phase 77"));
  }
}

/// Any change of any byte: the file is taken or refused, never read beyond its end.
TEST(PhaseNamesOfAnImage, SurviveDamage) {
  std::vector<std::byte> phases;
  put_record(phases, 9, "multiply");
  const std::vector<std::byte> good = elf_with(phases);
  std::mt19937 random(3);
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (int n = 0; n < 8; ++n) {
      std::vector<std::byte> bad = good;
      bad[i] = static_cast<std::byte>(random());
      if (n == 7) bad.resize(i);
      try {
        parse_image(bad, "image.elf");
      } catch (const InputError&) {
      }
    }
  }
}

}  // namespace
}  // namespace torolux::test
