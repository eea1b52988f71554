// SPDX-License-Identifier: MIT
// Proves: what launchers tell by the environment is understood, and a child is told none of it.
#include "emulator/ranks/launched.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <utility>

#include "emulator/ranks/starter.hpp"

namespace torolux::ranks {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Not;
using testing::StartsWith;

/// Variables for a while, and none that this test itself may have been started with.
class Environment {
 public:
  explicit Environment(const std::vector<std::pair<std::string, std::string>>& variables) {
    for (const char* name : kNames) ::unsetenv(name);
    for (const auto& [name, value] : variables) ::setenv(name.c_str(), value.c_str(), 1);
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;
  ~Environment() {
    for (const char* name : kNames) ::unsetenv(name);
  }

 private:
  static constexpr std::array<const char*, 6> kNames = {
      "OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK", "PMI_SIZE", "PMI_RANK", "SLURM_STEP_NUM_TASKS", "PMIX_RANK"};
};

unsigned count_with(const std::vector<std::pair<std::string, std::string>>& variables) {
  const Environment environment(variables);
  return launched_ranks().count;
}

TEST(LaunchedRanks, AreToldByEachLauncher) {
  EXPECT_EQ(count_with({}), 1U);
  EXPECT_EQ(count_with({{"OMPI_COMM_WORLD_SIZE", "4"}, {"OMPI_COMM_WORLD_RANK", "3"}}), 4U);
  EXPECT_EQ(count_with({{"PMI_SIZE", "2"}, {"PMI_RANK", "0"}}), 2U);
  EXPECT_EQ(count_with({{"SLURM_STEP_NUM_TASKS", "8"}, {"PMIX_RANK", "7"}}), 8U);
  const Environment environment({{"PMI_SIZE", "5"}, {"PMI_RANK", "4"}});
  EXPECT_EQ(launched_ranks().own, 4U);
}

TEST(LaunchedRanks, AreOneWhereTheNumbersAreNone) {
  EXPECT_EQ(count_with({{"SLURM_STEP_NUM_TASKS", "8"}}), 1U) << "a job array without MPI";
  EXPECT_EQ(count_with({{"PMI_SIZE", "many"}, {"PMI_RANK", "0"}}), 1U);
  EXPECT_EQ(count_with({{"PMI_SIZE", "2"}, {"PMI_RANK", "2"}}), 1U);
  EXPECT_EQ(count_with({{"PMI_SIZE", ""}, {"PMI_RANK", ""}}), 1U);
}

TEST(LaunchedRanks, ChildrenAreNone) {
  const Environment environment({{"OMPI_COMM_WORLD_SIZE", "4"}, {"PMI_RANK", "0"}, {"PMIX_RANK", "1"}});
  const std::vector<std::string> kept = environment_of_no_rank();
  for (const char* prefix : {"OMPI_", "PMI_", "PMIX_"}) EXPECT_THAT(kept, Not(Contains(StartsWith(prefix))));
  EXPECT_THAT(kept, Contains(StartsWith("PATH=")));
}

TEST(LaunchedRanks, AUsersSettingsForALauncherStay) {
  const Environment environment({});
  ::setenv("SLURM_STEP_NUM_TASKS", "1", 1);  // of a job
  ::setenv("OMPI_MCA_btl", "self", 1);
  ::setenv("HYDRA_IFACE", "eth0", 1);
  ::setenv(kStarterVariable, "another's", 1);
  const std::vector<std::string> kept = environment_of_no_rank();
  EXPECT_THAT(kept, AllOf(Contains("OMPI_MCA_btl=self"), Contains("HYDRA_IFACE=eth0")));
  EXPECT_THAT(kept, Not(Contains(StartsWith(kStarterVariable))));
  for (const char* name : {"OMPI_MCA_btl", "HYDRA_IFACE", kStarterVariable}) ::unsetenv(name);
}

}  // namespace
}  // namespace torolux::ranks
