// SPDX-License-Identifier: MIT
// Proves: flags are read section by section; what a linker says is explained once, with its numbers, whatever else it
// says; a compiler's errors are passed on and kept, and one that is not there is named with its package.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <fstream>
#include <sstream>

#include "emulator/errors.hpp"
#include "host_tools/toolchain/compiler_process.hpp"
#include "host_tools/toolchain/kit.hpp"
#include "host_tools/toolchain/link_advice.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(FlagsOfTheKit, AreReadBySection) {
  const std::string text = "# -not a flag\n[all]\n-a\n\n# why\n-b=1\n[c++]\n-c\n[link]\n-d\n[all]\n-e";
  EXPECT_THAT(flags_of(text, {"all"}), ElementsAre("-a", "-b=1", "-e"));
  EXPECT_THAT(flags_of(text, {"link", "c++"}), ElementsAre("-c", "-d"));
  EXPECT_THAT(flags_of(text, {"none"}), IsEmpty());
  EXPECT_THAT(flags_of("", {"all"}), IsEmpty());
}

TEST(FlagsOfTheKit, AreThoseOfTheCheckout) {
  std::ifstream stream(std::string(TOROLUX_SOURCE_DIR) + "/cmake/pe_flags.txt");
  std::stringstream text;
  text << stream.rdbuf();
  EXPECT_THAT(flags_of(text.str(), {"all"}), AllOf(Contains("-march=rv32imafc"), Contains("-mabi=ilp32f")));
  EXPECT_THAT(flags_of(text.str(), {"compiled"}), Contains("-ffp-contract=off"));
  EXPECT_THAT(flags_of(text.str(), {"c++"}), Contains("-fno-exceptions"));
  EXPECT_THAT(flags_of(text.str(), {"defaults"}), ElementsAre("-O2", "-g"));
}

RC_GTEST_PROP(FlagsOfTheKit, WhateverTheFileHolds, (const std::string& text)) {
  for (const std::string& flag : flags_of(text, {"all", "c++"})) {
    RC_ASSERT(flag.starts_with('-'));
    RC_ASSERT(flag.find('\n') == std::string::npos);
  }
}

TEST(LinkAdvice, ExplainsEachKindOnce) {
  const std::string twice = "x.c: undefined reference to `main'\n";
  EXPECT_THAT(link_advice(twice + twice), ElementsAre(HasSubstr("the image has no beginning")));
  EXPECT_THAT(link_advice("ld: region `local' overflowed by 6295552 bytes"),
              ElementsAre(HasSubstr("the image is 6295552 bytes larger")));
  EXPECT_THAT(link_advice("ld: the image is larger than its limit\nld: region `local' overflowed by 8 bytes"),
              ElementsAre(HasSubstr("the image is 8 bytes larger")));
  EXPECT_THAT(link_advice("undefined reference to `__cxa_throw'\nundefined reference to `typeinfo for int'"),
              ElementsAre(HasSubstr("no exceptions")));
  EXPECT_THAT(link_advice("undefined reference to `std::cout'\nundefined reference to `__cxa_throw'"),
              ElementsAre(HasSubstr("no exceptions"), HasSubstr("use printf")));
  EXPECT_THAT(link_advice("main.c:3:1: error: unknown type name"), IsEmpty());
}

RC_GTEST_PROP(LinkAdvice, WhateverTheLinkerSays, (const std::string& before, const std::string& after)) {
  const std::string said = before + "region `local' overflowed by " + after + "\n";
  RC_ASSERT(!link_advice(said).empty());
  RC_ASSERT(link_advice(said) == link_advice(said + said));
}

TEST(TheCompilersProcess, PassesErrorsOnAndKeepsThem) {
  testing::internal::CaptureStderr();
  const CompilerEnd end = run_compiler({"sh", "-c", "echo first >&2; echo second >&2; exit 7"}, "dash");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "first\nsecond\n");
  EXPECT_EQ(end.errors, "first\nsecond\n");
  EXPECT_EQ(end.exit_code, 7);
  EXPECT_EQ(run_compiler({"sh", "-c", "kill -9 $$"}, "dash").exit_code, 128 + 9);
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_compiler({"sh", "-c", "head -c 3000000 /dev/zero >&2"}, "dash").errors.size(), kMostKeptErrors);
  EXPECT_EQ(testing::internal::GetCapturedStderr().size(), 3'000'000U);
}

TEST(TheCompilersProcess, NamesThePackageOfACompilerThatIsNotThere) {
  const std::string message =
      testing_support::message_of<InputError>([] { run_compiler({"there-is-no-such-compiler"}, "some-package"); });
  EXPECT_THAT(message, AllOf(HasSubstr("there-is-no-such-compiler"), HasSubstr("apt-get install some-package")));
}

}  // namespace
}  // namespace torolux
