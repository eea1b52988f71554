// SPDX-License-Identifier: MIT
// Proves: a run is claimed by one process at a time; what a dead one claimed is free; what lives elsewhere is believed
// for a while.
#include "host_tools/study/claim.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace torolux::study {
namespace {

using testing_support::TemporaryFolder;

void make_older(const std::filesystem::path& file, std::chrono::seconds age) {
  struct stat status {};
  ::stat(file.c_str(), &status);
  const std::array<timespec, 2> times{
      {{status.st_mtim.tv_sec - age.count(), 0}, {status.st_mtim.tv_sec - age.count(), 0}}};
  ::utimensat(AT_FDCWD, file.c_str(), times.data(), 0);
}

/// A process that takes the lock and does not let go of it.
pid_t holder_of(const std::filesystem::path& lock) {
  const pid_t holder = ::fork();
  if (holder == 0) {
    const auto claim = Claim::take(lock);
    for (;;) ::pause();
  }
  while (!std::filesystem::exists(lock) || std::filesystem::file_size(lock) == 0) ::usleep(1000);
  return holder;
}

TEST(Claim, IsHeldByOneAndFreeAfterwards) {
  const TemporaryFolder folder;
  const std::filesystem::path lock = folder.path() / "a.lock";
  {
    const auto first = Claim::take(lock);
    ASSERT_TRUE(first);
    EXPECT_FALSE(Claim::take(lock));
  }
  EXPECT_EQ(folder.files(), 0U);
  EXPECT_TRUE(Claim::take(lock));
}

TEST(Claim, OfADeadProcessIsFree) {
  const TemporaryFolder folder;
  const std::filesystem::path lock = folder.path() / "a.lock";
  const pid_t holder = holder_of(lock);
  EXPECT_FALSE(Claim::take(lock));
  ::kill(holder, SIGKILL);
  ::waitpid(holder, nullptr, 0);
  EXPECT_TRUE(Claim::take(lock));
  EXPECT_EQ(folder.files(), 0U);
}

TEST(Claim, LastsAsLongAsTheRunThatADeadStudyLeft) {
  const TemporaryFolder folder;
  const std::filesystem::path lock = folder.path() / "a.lock";
  const pid_t child = ::fork();
  if (child == 0) {
    for (;;) ::pause();
  }
  const pid_t study = ::fork();
  if (study == 0) {
    const auto claim = Claim::take(lock);
    claim->note_child(child);
    ::raise(SIGKILL);
  }
  ::waitpid(study, nullptr, 0);
  EXPECT_FALSE(Claim::take(lock));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  EXPECT_TRUE(Claim::take(lock));
}

TEST(Claim, OfAnotherComputerIsBelievedWhileItShowsLife) {
  const TemporaryFolder folder;
  const std::filesystem::path lock = folder.path() / "a.lock";
  std::ofstream(lock) << "another-boot/pid:[1] " << ::getpid() << " 1\n";
  EXPECT_FALSE(Claim::take(lock));
  make_older(lock, kBelieved - kHeartbeat);
  EXPECT_FALSE(Claim::take(lock));
  make_older(lock, 2 * kHeartbeat);
  EXPECT_TRUE(Claim::take(lock));
}

TEST(Claim, WithoutANameIsFreeSoon) {
  const TemporaryFolder folder;
  const std::filesystem::path lock = folder.path() / "a.lock";
  std::ofstream(lock).flush();
  EXPECT_FALSE(Claim::take(lock)) << "it may be about to be written";
  make_older(lock, kHeartbeat);
  EXPECT_TRUE(Claim::take(lock));
}

}  // namespace
}  // namespace torolux::study
