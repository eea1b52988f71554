// SPDX-License-Identifier: MIT
// Typical mistakes in programs of one's own: each ends the run with exit code 3 and a message that says what and where,
// the same on every engine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "tests/machine/process.hpp"

namespace torolux::test {
namespace {

using testing::HasSubstr;

struct Mistake {
  std::string name;
  std::string pes;
  std::vector<std::string> says;  ///< what the message holds
};

std::string errors_of(const Mistake& mistake, const std::string& engine) {
  const std::string image = (std::filesystem::path(TOROLUX_FIRMWARE_DIR) / "mistakes.elf").string();
  const Finished end = run_torolux({"run", image, "--pes", mistake.pes, "--engine", engine, "--set",
                                    "processor.most_cycles_between_hints=1000000", "--", mistake.name});
  EXPECT_EQ(end.exit_code, 3) << end.output << end.errors;
  // After a trap QEMU's clock is ahead by what stood behind the instruction in its block.
  return std::regex_replace(end.errors, std::regex(R"( \(cycle \d+\))"), "");
}

class EveryMistake : public testing::TestWithParam<Mistake> {};

TEST_P(EveryMistake, IsToldWithWhatAndWhereOnEveryEngine) {
  const std::string errors = errors_of(GetParam(), "translated");
  for (const std::string& words : GetParam().says) EXPECT_THAT(errors, HasSubstr(words));
  EXPECT_EQ(errors_of(GetParam(), "interpreted"), errors);
  EXPECT_EQ(errors_of(GetParam(), "qemu"), errors);
}

INSTANTIATE_TEST_SUITE_P(
    Mistakes, EveryMistake,
    testing::Values(
        Mistake{"out_of_memory", "1x1", {"PE 0: trap: store outside local memory", "out_of_memory", "mistakes.c:"}},
        Mistake{"message_too_long", "1x1", {"PE 0: ", "1048577 bytes", "1048576", "message_too_long", "mistakes.c:"}},
        Mistake{"no_room", "1x1", {"PE 0: ", "5 bytes", "4", "no_room", "mistakes.c:"}},
        Mistake{"no_such_pe", "2x2", {"PE ", "no PE 4", "no_such_pe", "mistakes.c:"}},
        Mistake{"both_receive_first", "2x1", {"2 PEs", "both_receive_first", "mistakes.c:"}},
        Mistake{"too_deep", "1x1", {"PE 0: trap", "a stack overflow?", "too_deep"}},
        Mistake{"never_ends", "1x1", {"PE 0: no HINT for more than 1000000 cycles", "never_ends", "mistakes.c:"}},
        Mistake{"not_all_at_the_barrier", "2x2", {"3 PEs", "not_all_at_the_barrier", "torolux_barrier"}},
        Mistake{"false_assertion", "1x1", {"PE 0: ", "assertion", "torolux_pes() == 0", "mistakes.c:"}},
        Mistake{"store_into_a_constant", "1x1", {"PE 0: trap: store into a page of code", "store_into_a_constant"}},
        Mistake{"file_that_nobody_named", "1x1", {"PE 0: ", "data.txt cannot be read", "file_that_nobody_named"}},
        Mistake{"nowhere_to_go", "1x1", {"PE 0: trap: no access to the instruction", "nowhere_to_go"}},
        Mistake{"no_memory_for_what_waits", "2x1", {"PE ", "no memory", "wait", "no_memory_for_what_waits"}},
        Mistake{"different_sizes", "2x1", {"PE 1: ", "8 bytes", "4", "different_sizes", "mistakes.c:"}}),
    [](const auto& mistake) { return mistake.param.name; });

}  // namespace
}  // namespace torolux::test
