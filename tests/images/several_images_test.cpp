// SPDX-License-Identifier: MIT
// Different images on different PEs: the same on all engines; a file that is named twice is held once.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "host_tools/cli/image_options.hpp"
#include "host_tools/report/settings_json.hpp"
#include "tests/images/run_support.hpp"

namespace torolux {
namespace {

using test::small_setup;
using test::tell;
using test::test_image;
using test::Told;
using testing::HasSubstr;

std::string file(const char* name) {
  return (std::filesystem::path(TOROLUX_FIRMWARE_DIR) / (std::string(name) + ".elf")).string();
}

/// What UsageError or InputError says.
template <class Action>
std::string refusal(Action action) {
  try {
    action();
  } catch (const UsageError& error) {
    return error.what();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

ImageSet two_images() {
  return {{test_image("hello"), test_image("jumps")}, {0, 1, 1, 0}};
}

TEST(SeveralImages, RunTheSameOnAllEngines) {
  const Told qemu = tell(small_setup("qemu", 2, 2), two_images());
  ASSERT_EQ(qemu.failure, "");
  EXPECT_THAT(qemu.lines, testing::Contains(HasSubstr("Hello from PE 3 of 4")));
  EXPECT_THAT(qemu.lines, testing::Contains(testing::AllOf(testing::StartsWith("2 @ "), HasSubstr("other link 42"))));
  for (const char* engine : {"translated", "interpreted"}) {
    for (const unsigned threads : {1U, 3U}) {
      const Told other = tell(small_setup(engine, 2, 2, threads), two_images());
      EXPECT_EQ(other.failure, "") << engine;
      EXPECT_EQ(other.lines, qemu.lines) << engine;
      EXPECT_EQ(other.figures.now, qemu.figures.now) << engine;
      EXPECT_EQ(other.figures.trace_hash, qemu.figures.trace_hash) << engine;
    }
  }
  MachineSetup mixed = small_setup("translated", 2, 2);
  mixed.debugging.qemu_pes = {0, 1};
  EXPECT_EQ(tell(mixed, two_images()).figures.trace_hash, qemu.figures.trace_hash);
}

TEST(SeveralImages, AFaultIsToldByThePesOwnImage) {
  const std::string failure =
      tell(small_setup("translated", 2, 1), ImageSet({test_image("hello"), test_image("last_words")}, {1, 0})).failure;
  EXPECT_THAT(failure, HasSubstr("tests/images/last_words.cpp"));
}

TEST(SeveralImages, AFileThatIsNamedTwiceIsOne) {
  ImageOptions options;
  options.others = file("hello");
  options.of_pes = {{{1}, file("token")}, {{0, 3}, std::string(TOROLUX_FIRMWARE_DIR) + "/../bin/hello.elf"}};
  const RunImages images = images_of(options, 5);
  ASSERT_EQ(images.files.size(), 2U);
  EXPECT_EQ(images.file_of_pe, (std::vector<std::uint32_t>{1, 0, 1, 1, 1}));
  EXPECT_EQ(images.names(), "token.elf, hello.elf");
  const ImageSet loaded = load_images(images);
  EXPECT_EQ(loaded.images().size(), 2U);
  EXPECT_EQ(&loaded.of(0), &loaded.of(4));
  options.of_pes = {{{0, 1, 2, 3, 4}, file("hello")}};
  EXPECT_TRUE(images_of(options, 5).file_of_pe.empty());
}

TEST(SeveralImages, EachPeMustHaveOne) {
  ImageOptions options;
  EXPECT_THAT(refusal([&] { images_of(options, 4); }), HasSubstr("IMAGE is missing"));
  options.of_pes = {{{1}, file("hello")}};
  EXPECT_THAT(refusal([&] { images_of(options, 5); }), HasSubstr("PEs 0,2-4: no image"));
  options.of_pes.push_back({{0, 1}, file("token")});
  EXPECT_THAT(refusal([&] { images_of(options, 2); }), HasSubstr("PE 1 has two images"));
  options.of_pes = {{{7}, file("hello")}};
  EXPECT_THAT(refusal([&] { images_of(options, 2); }), HasSubstr("there is no PE 7"));
}

TEST(SeveralImages, AreInTheSettingsAndInTheCommandLine) {
  ImageOptions options;
  options.others = file("hello");
  options.of_pes = {{{0, 1, 3}, file("token")}};
  MachineSetup setup = small_setup("translated", 2, 2);
  const auto settings = settings_json(setup, {images_of(options, 4), {}, {}});
  const std::vector<std::string> words = command_line_of(settings);
  ASSERT_GE(words.size(), 5U);
  EXPECT_EQ((std::vector<std::string>(words.begin(), words.begin() + 5)),
            (std::vector<std::string>{"run", "--image", "0-1,3=" + file("token"), "--image", "2=" + file("hello")}));
  options.of_pes = {{{0, 1, 2}, file("token")}};
  EXPECT_NE(determining(settings), determining(settings_json(setup, {images_of(options, 4), {}, {}})));
}

}  // namespace
}  // namespace torolux
