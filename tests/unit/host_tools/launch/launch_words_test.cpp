// SPDX-License-Identifier: MIT
// Proves: a launcher's words stand in front of this command line, which loses what only the starter is to read, and no
// more.
#include "host_tools/launch/launch_words.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emulator/errors.hpp"
#include "emulator/ranks/mpi_ranks.hpp"

namespace torolux::launch {
namespace {

using testing::ElementsAre;

bool has_mpi() {
  try {
    return !ranks::mpi_launcher().empty();
  } catch (const UsageError&) {
    return false;
  }
}

class LaunchWords : public testing::Test {
 protected:
  void SetUp() override {
    if (!has_mpi()) GTEST_SKIP() << "this build has no MPI";
  }
};

TEST_F(LaunchWords, TakeOutWhatIsForTheStarter) {
  EXPECT_THAT(launch_words({3, " srun  --label "}, "/bin/torolux",
                           {"run", "--ranks", "3", "a.elf", "--launcher= srun  --label ", "--pes", "2x2"}),
              ElementsAre("srun", "--label", "-n", "3", "/bin/torolux", "run", "a.elf", "--pes", "2x2"));
  EXPECT_THAT(launch_words({2, "m"}, "t", {"render", "--ranks=2", "--launcher", "m", "s"}),
              ElementsAre("m", "-n", "2", "t", "render", "s"));
}

TEST_F(LaunchWords, LeaveAProgramsOwnWords) {
  EXPECT_THAT(launch_words({2, "m"}, "t", {"run", "--ranks", "2", "a.elf", "--", "--ranks", "7", "--launcher=x"}),
              ElementsAre("m", "-n", "2", "t", "run", "a.elf", "--", "--ranks", "7", "--launcher=x"));
}

TEST_F(LaunchWords, BeginWithTheLauncherOfTheBuild) {
  const std::vector<std::string> words = launch_words({5, ""}, "t", {"render", "s", "--ranks", "5"});
  const std::vector<std::string> launcher = ranks::mpi_launcher();
  ASSERT_GT(words.size(), launcher.size() + 3);
  EXPECT_TRUE(std::equal(launcher.begin(), launcher.end(), words.begin()));
  EXPECT_EQ(words[launcher.size()], "-n");
  EXPECT_EQ(words[launcher.size() + 1], "5");
}

TEST_F(LaunchWords, AreRefusedWhereThereAreNone) {
  EXPECT_THROW(launch_words({2, "  "}, "t", {"render"}), UsageError);
}

TEST(LaunchEnvironment, NamesTheSocket) {
  const std::vector<std::string> variables = launch_environment("torolux-1");
  EXPECT_EQ(std::count(variables.begin(), variables.end(), "TOROLUX_STARTER=torolux-1"), 1);
}

}  // namespace
}  // namespace torolux::launch
