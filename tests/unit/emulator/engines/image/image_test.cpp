// SPDX-License-Identifier: MIT
// The image loader takes what follows the rules, says which rule the rest breaks, and survives any damage.
#include "emulator/engines/image/image.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "emulator/errors.hpp"
#include "tests/unit/emulator/engines/elf_builder.hpp"
#include "tests/unit/emulator/engines/engine_support.hpp"

namespace torolux::test {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t kNop = 0x13;

ElfPlan good_plan() {
  ElfPlan plan;
  plan.code = {kNop, kNop, kNop, kNop};
  plan.symbols = {{"first", 0x8000'0000U, 8}, {"second", 0x8000'0008U, 0}};
  return plan;
}

Image load(const ElfPlan& plan) {
  const TemporaryFile file("image.elf", build_elf(plan));
  return load_image(file.path());
}

/// The loader's message, or nothing where it takes the image.
std::string refusal(const ElfPlan& plan) {
  try {
    load(plan);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Image, KeepsSegmentsAndSymbols) {
  const Image image = load(good_plan());
  ASSERT_EQ(image.segments.size(), 2U);
  EXPECT_EQ(image.segments[0].contents.size(), 16U);
  EXPECT_TRUE(image.segments[0].executable);
  EXPECT_FALSE(image.segments[0].writable);
  EXPECT_TRUE(image.segments[1].writable);
  EXPECT_EQ(image.segments[1].memory_bytes, 4096U);
  EXPECT_EQ(image.niu_window, 0x8000'1000U);
  EXPECT_EQ(image.stores_begin, 0x8000'2000U);
}

TEST(Image, DescribesAddressesByTheNearestSymbol) {
  const Image image = load(good_plan());
  EXPECT_EQ(image.describe(0x8000'0000U), "first");
  EXPECT_EQ(image.describe(0x8000'0004U), "first+0x4");
  EXPECT_EQ(image.describe(0x8000'000CU), "second+0x4") << "a label without a size speaks for what follows it";
  EXPECT_EQ(image.describe(0x9000'0000U), "0x90000000");
  EXPECT_EQ(image.describe(0x10), "0x10");
}

TEST(Image, LoadsContentsAndClearsTheRest) {
  const Image image = load(good_plan());
  std::vector<std::byte> memory(256 * 1024, std::byte{0xAA});
  image.load_into(memory);
  EXPECT_EQ(memory[0], std::byte{0x13});
  EXPECT_EQ(memory[16], std::byte{0xAA}) << "between segments nothing is written";
  EXPECT_EQ(memory[0x1000], std::byte{0});
  EXPECT_EQ(memory[0x1FFF], std::byte{0});
  EXPECT_EQ(memory[0x2000], std::byte{0xAA});
}

TEST(Image, RefusesAPeThatIsTooSmall) {
  const Image image = load(good_plan());
  std::vector<std::byte> memory(0x1FFF);
  try {
    image.load_into(memory);
    FAIL() << "loaded 8192 bytes into 8191";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("8192"));
    EXPECT_THAT(error.what(), HasSubstr("8191"));
  }
}

TEST(Image, NamesTheRuleThatIsBroken) {
  const auto with = [](auto change) {
    ElfPlan plan = good_plan();
    change(plan);
    return refusal(plan);
  };
  EXPECT_EQ(with([](ElfPlan&) {}), "");
  EXPECT_THAT(with([](ElfPlan& p) { p.entry = 0x8000'0004U; }), HasSubstr("starts at 0x80000004"));
  EXPECT_THAT(with([](ElfPlan& p) { p.name_window = false; }), HasSubstr("no symbol __niu_window"));
  EXPECT_THAT(with([](ElfPlan& p) { p.name_stores = false; }), HasSubstr("no symbol __stores_begin"));
  EXPECT_THAT(with([](ElfPlan& p) { p.code_flags = 7; }), HasSubstr("both code and writable"));
  EXPECT_THAT(with([](ElfPlan& p) { p.code_flags = 4; }), HasSubstr("no code at 0x80000000"));
  EXPECT_THAT(with([](ElfPlan& p) { p.code.clear(); }), HasSubstr("no code at 0x80000000"));
  EXPECT_THAT(with([](ElfPlan& p) { p.data_address = 0x8000'0008U; }), HasSubstr("overlap"));
  EXPECT_THAT(with([](ElfPlan& p) { p.data_address = 0x8000'0800U; }), HasSubstr("on one page"));
  EXPECT_THAT(with([](ElfPlan& p) { p.data_address = 0x7000'0000U; }), HasSubstr("outside local memory"));
  EXPECT_THAT(with([](ElfPlan& p) { p.data_bytes = 0xFFFF'F000U; }), HasSubstr("outside local memory"));
  EXPECT_THAT(with([](ElfPlan& p) { p.window = 0x8000'1004U; }), HasSubstr("NIU window"));
  EXPECT_THAT(with([](ElfPlan& p) { p.window = 0x8000'2000U; }), HasSubstr("NIU window"));
  EXPECT_THAT(with([](ElfPlan& p) { p.window = 0xFFFF'F000U; }), HasSubstr("NIU window"));
  EXPECT_THAT(with([](ElfPlan& p) { p.data_flags = 4; }), HasSubstr("not writable"));
  EXPECT_THAT(with([](ElfPlan& p) { p.stores_begin = 0x8000'1800U; }), HasSubstr("NIU window"));
}

TEST(Image, RefusesWhatIsNoImage) {
  EXPECT_THROW(load_image("/"), InputError);
  EXPECT_THROW(load_image("/nowhere/at/all.elf"), InputError);
  EXPECT_THROW(load_image("/proc/self/exe"), InputError);
  const TemporaryFile empty("empty.elf", {});
  EXPECT_THROW(load_image(empty.path()), InputError);
}

std::vector<std::byte> contents_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(stream)), {});
  std::vector<std::byte> bytes(text.size());
  std::transform(text.begin(), text.end(), bytes.begin(), [](char c) { return static_cast<std::byte>(c); });
  return bytes;
}

/// True: loaded. What is refused must be refused as bad input; anything else is a failure of the test.
bool loads(const std::vector<std::byte>& contents) {
  const TemporaryFile file("damaged.elf", contents);
  try {
    const Image image = load_image(file.path());
    std::vector<std::byte> memory(protocol::kDefaultLocalMemory);
    image.load_into(memory);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

TEST(Image, EveryTruncationOfARealImageIsRefusedOrWhole) {
  const std::vector<std::byte> whole = contents_of(example_image("hello"));
  ASSERT_GT(whole.size(), 1000U) << "build the firmware first";
  ASSERT_TRUE(loads(whole));
  for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) {
    // The section headers stand at the end: without them there are no symbols.
    EXPECT_FALSE(loads({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(bytes)})) << bytes << " bytes";
  }
}

TEST(Image, DamagedHeadersNeverCrash) {
  const std::vector<std::byte> whole = build_elf(good_plan());
  std::mt19937 random(1);
  unsigned refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::vector<std::byte> damaged = whole;
    for (int change = 0; change < 3; ++change) {
      damaged[random() % damaged.size()] = static_cast<std::byte>(random());
    }
    refused += loads(damaged) ? 0 : 1;
  }
  EXPECT_GT(refused, 1000U);
}

}  // namespace
}  // namespace torolux::test
