// SPDX-License-Identifier: MIT
// The calls that lead to a trap, a failure, an endless loop and a hang are told, the same on all engines.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <regex>

#include "emulator/engines/image/backtrace.hpp"
#include "firmware/protocol/machine.hpp"
#include "tests/images/run_support.hpp"

namespace torolux {
namespace {

using test::line_with;
using test::small_setup;
using test::tell;
using test::test_image;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr const char* kSource = "tests/images/calls.cpp";

std::string failure(const char* engine, unsigned how, unsigned columns = 1) {
  return tell(small_setup(engine, columns, how), test_image("calls")).failure;
}

std::string at(const std::string& text) {
  return " at " + line_with(kSource, text);
}

/// Behind the first line: `innermost`, where it is, and what has called it.
testing::Matcher<std::string> calls_from(const std::string& innermost) {
  return AllOf(HasSubstr("innermost(torolux::pe::Niu&, unsigned long)" + innermost),
               HasSubstr("middle(torolux::pe::Niu&, unsigned long, unsigned long)" + at("  innermost(niu, how);")),
               HasSubstr(at("return middle(niu, how, depth + 1)")),
               HasSubstr("in torolux::pe::pe_main(torolux::pe::Niu&)" + at("tests::middle(niu, rows, 0)")),
               HasSubstr("in boot at firmware/boot/boot.cpp:"), HasSubstr("in _start at firmware/boot/start.S:"),
               Not(HasSubstr("\n  ...")));
}

class Calls : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Engines, Calls, testing::Values("qemu", "translated", "interpreted"));

TEST_P(Calls, ToATrapAreTold) {
  EXPECT_THAT(failure(GetParam(), 1), AllOf(StartsWith("PE 0: trap: illegal instruction at pc 0x"),
                                            ContainsRegex("cycle [0-9]+\\)\n  #0 0x"), calls_from(at("(\"unimp\")"))));
}
TEST_P(Calls, ToAProgramsOwnFailureAreTold) {
  EXPECT_THAT(failure(GetParam(), 2), AllOf(HasSubstr("in torolux::pe::Niu::fail("), calls_from(at("niu.fail("))));
}
TEST_P(Calls, ToAnEndlessLoopAreTold) {
  EXPECT_THAT(failure(GetParam(), 3), AllOf(HasSubstr("an endless loop?"), HasSubstr("in torolux::tests::"),
                                            HasSubstr(at("for (;;) asm volatile"))));
}
TEST_P(Calls, ToAMisuseOfTheNiuAreTold) {
  EXPECT_THAT(failure(GetParam(), 4), AllOf(HasSubstr("no such destination"), calls_from("")));
}
TEST_P(Calls, ToATrapInTheCLibraryAreTold) {
  EXPECT_THAT(failure(GetParam(), 6),
              AllOf(ContainsRegex("#0 0x[0-9a-f]+ in memset\n"), calls_from(at("std::memset"))));
}
TEST_P(Calls, ToAJumpToNowhereAreTold) {
  EXPECT_THAT(failure(GetParam(), 7), AllOf(HasSubstr("#0 0x00000000 in 0x"), calls_from(at("(never)();"))));
}

TEST_P(Calls, ToWhereEachPeOfAHangWaitsAreTold) {
  EXPECT_THAT(
      failure(GetParam(), 5, 4),
      AllOf(HasSubstr("20 PEs still wait to receive"),
            ContainsRegex("19 PEs wait in receive" + at("for (;;) niu.receive();") +
                          ", pc 0x[0-9a-f]+ \\(1, 2, 3, .*, 16, ...\\)"),
            ContainsRegex("1 PE waits in receive at " + std::string(kSource) + ":[0-9]+, pc 0x[0-9a-f]+ \\(0\\)"),
            calls_from(""), HasSubstr("in torolux::tests::(anonymous namespace)::wait_for_ever(")));
}

/// Without the cycle: after a trap QEMU's clock is ahead (emulator/engines/translated/README.md).
std::string without_cycle(const std::string& text) {
  return std::regex_replace(text, std::regex(" \\(cycle [0-9]+\\)"), "");
}

TEST(Backtraces, AreTheSameOnAllEnginesAndThreads) {
  for (unsigned how = 1; how <= 7; ++how) {
    const std::string qemu = without_cycle(failure("qemu", how, 2));
    EXPECT_EQ(without_cycle(failure("translated", how, 2)), qemu);
    EXPECT_EQ(without_cycle(failure("interpreted", how, 2)), qemu);
    EXPECT_EQ(without_cycle(tell(small_setup("translated", 2, how, 1), test_image("calls")).failure), qemu);
  }
}

// ---- Whatever stands in image and memory ----

/// A stack of calls, whatever it holds, ends: debug information with bytes that have changed, and memory of any
/// content.
TEST(Backtraces, EndWhateverImageAndMemoryHold) {
  constexpr unsigned kSeed = 17, kCases = 300, kMostChanged = 40;
  const Image image = test_image("calls");
  const std::vector<std::byte> file = read_image_file(image.file);
  std::mt19937 random(kSeed);
  const auto below = [&random](std::size_t end) { return static_cast<std::uint32_t>(random() % end); };
  for (unsigned number = 0; number < kCases; ++number) {
    std::vector<std::byte> changed = file;
    // Code is not believed either, but what tells of it stands behind it.
    const std::size_t first = number % 2 == 0 ? 0 : file.size() / 8;
    for (unsigned i = below(kMostChanged); i > 0; --i)
      changed[first + below(file.size() - first)] = static_cast<std::byte>(random());
    if (number % 8 == 0) changed.resize(below(changed.size()));
    const DebugInfo debug_info(std::move(changed));
    FrameRegisters frame;
    const auto code = [&] { return protocol::kLocalMemoryBase + below(image.segments.front().contents.size()); };
    frame.pc = number % 16 == 1 ? static_cast<std::uint32_t>(random()) : code();
    for (auto& x : frame.x) x = protocol::kLocalMemoryBase + below(1U << 16U) * 4;
    frame.x[1] = code();
    const CallStack stack = call_stack(image, debug_info, frame, [&](std::uint32_t) -> std::optional<std::uint32_t> {
      if (below(16) == 0) return std::nullopt;
      return code();
    });
    ASSERT_GE(stack.frames.size(), 1U);
    ASSERT_LE(stack.frames.size(), kMostFrames);
    ASSERT_FALSE(in_words(stack).empty());
  }
}

}  // namespace
}  // namespace torolux
