// SPDX-License-Identifier: MIT
// Proves: files are written whole or not at all, what cannot be written is refused beforehand and afterwards, and
// nothing is left behind.
#include "host_tools/files/write_file.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>

#include "emulator/errors.hpp"
#include "host_tools/picture/picture.hpp"
#include "tests/unit/host_tools/picture/sample_picture.hpp"

namespace torolux {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing_support::bytes_of;
using testing_support::message_of;
using testing_support::TemporaryFolder;

constexpr std::size_t kMost = 1U << 20U;

/// Within its life no file can grow beyond so many bytes: as a full disk, but for the error's name.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit now{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &now);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(WriteFile, ReplacesAndLeavesNothingElse) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "a";
  write_file(file, "first, and longer");
  write_file(file, "second");
  EXPECT_EQ(read_file(file, kMost), bytes_of("second"));
  EXPECT_EQ(folder.files(), 1U);
}

/// Of the file system.
bool has_files_without_a_name(const TemporaryFolder& folder) {
  const int unnamed = ::open(folder.path().c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
  if (unnamed >= 0) ::close(unnamed);
  return unnamed >= 0;
}

TEST(WriteFile, WhoIsKilledWhileItWritesLeavesNothing) {
  const TemporaryFolder folder;
  if (!has_files_without_a_name(folder)) GTEST_SKIP();
  const pid_t child = ::fork();
  if (child == 0) {
    FileWriter writer(folder.path() / "a");
    writer.append(bytes_of("half of it"));
    ::raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(folder.files(), 0U);
}

/// From now on this answers a system call of this process.
bool answer(std::uint32_t call, std::uint32_t with) {
  std::array<sock_filter, 4> program = {{{BPF_LD | BPF_W | BPF_ABS, 0, 0, offsetof(seccomp_data, nr)},
                                         {BPF_JMP | BPF_JEQ | BPF_K, 0, 1, call},
                                         {BPF_RET | BPF_K, 0, 0, with},
                                         {BPF_RET | BPF_K, 0, 0, SECCOMP_RET_ALLOW}}};
  const sock_fprog filter{program.size(), program.data()};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

/// As some file systems and containers do with links.
constexpr std::uint32_t kRefused = SECCOMP_RET_ERRNO | EPERM;

// So whoever is killed meanwhile leaves nothing beside it.
TEST(WriteFile, ANewFileHasNoOtherNameBefore) {
  const TemporaryFolder folder;
  if (!has_files_without_a_name(folder)) GTEST_SKIP();
  const pid_t child = ::fork();
  if (child == 0) {
    FileWriter writer(folder.path() / "a");
    writer.append(bytes_of("whole"));
    if (!answer(__NR_rename, SECCOMP_RET_KILL_PROCESS)) ::_exit(2);
    writer.finish();
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 2) GTEST_SKIP() << "this computer has no seccomp";
  EXPECT_EQ(status, 0);
  EXPECT_EQ(read_file(folder.path() / "a", kMost), bytes_of("whole"));
  EXPECT_EQ(folder.files(), 1U);
}

// What takes time, the last bytes of a network's file system, comes before the name under which it is replaced.
TEST(WriteFile, WhoIsKilledWhileItClosesLeavesTheOldFileAlone) {
  const TemporaryFolder folder;
  if (!has_files_without_a_name(folder)) GTEST_SKIP();
  const fs::path file = folder.path() / "a";
  write_file(file, "old");
  const pid_t child = ::fork();
  if (child == 0) {
    FileWriter writer(file);
    writer.append(bytes_of("new"));
    if (!answer(__NR_close, SECCOMP_RET_KILL_PROCESS)) ::_exit(2);
    writer.finish();
    ::_exit(1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 2) GTEST_SKIP() << "this computer has no seccomp";
  EXPECT_TRUE(WIFSIGNALED(status)) << "nothing was closed";
  EXPECT_EQ(read_file(file, kMost), bytes_of("old"));
  EXPECT_EQ(folder.files(), 1U);
}

TEST(WriteFile, WhereLinksAreRefusedItIsWrittenToo) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "a";
  const pid_t child = ::fork();
  if (child == 0) {
    if (!answer(__NR_linkat, kRefused)) ::_exit(2);
    try {
      check_file_writable(file);
      write_file(file, "first");
      write_file(file, "second");
    } catch (const std::exception&) {
      ::_exit(1);
    }
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 2) GTEST_SKIP() << "this computer has no seccomp";
  EXPECT_EQ(status, 0);
  EXPECT_EQ(read_file(file, kMost), bytes_of("second"));
  EXPECT_EQ(folder.files(), 1U);
}

TEST(WriteFile, NameOfGreatestLength) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / std::string(255, 'n');
  write_file(file, "x");
  EXPECT_TRUE(fs::exists(file));
}

TEST(WriteFile, FollowsALink) {
  const TemporaryFolder folder;
  write_file(folder.path() / "target", "old");
  fs::create_symlink(folder.path() / "target", folder.path() / "link");
  write_file(folder.path() / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_EQ(read_file(folder.path() / "target", kMost), bytes_of("new"));
}

TEST(WriteFile, DoesNotReplaceADevice) {
  write_file("/dev/null", "x");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  check_file_writable("/dev/null");
}

TEST(WriteFile, FullDiskKeepsTheOldFileAndLeavesNothing) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "a.pfm";
  write_file(file, "old");
  {
    const FileSizeLimit limit(4096);
    const Picture picture = testing_support::sample_picture(64, 64);
    EXPECT_THAT(message_of<InputError>([&] { write_picture(picture, file); }), HasSubstr("a.pfm"));
  }
  EXPECT_EQ(read_file(file, kMost), bytes_of("old"));
  EXPECT_EQ(folder.files(), 1U);
}

// A shell's log, which other programs write before and after us.
TEST(WriteFile, WhatIsOurStandardErrorIsWrittenToAndNotReplaced) {
  const TemporaryFolder folder;
  const fs::path log = folder.path() / "log";
  const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  const int kept = ::dup(STDERR_FILENO);
  ::dup2(file, STDERR_FILENO);
  EXPECT_EQ(::write(STDERR_FILENO, "before, ", 8), 8);
  write_file("/dev/stderr", "this, ");
  write_file(log, "that, ");
  EXPECT_EQ(::write(file, "after", 5), 5);
  ::dup2(kept, STDERR_FILENO);
  ::close(kept);
  ::close(file);
  EXPECT_EQ(read_file(log, kMost), bytes_of("before, this, that, after"));
  EXPECT_EQ(folder.files(), 1U);
}

TEST(WriteFile, MissingFolderIsRefusedBeforehand) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "missing" / "a.png";
  EXPECT_THAT(message_of<InputError>([&] { check_writable(file); }), HasSubstr("missing/a.png"));
  EXPECT_THROW(write_file(file, "x"), InputError);
  EXPECT_EQ(folder.files(), 0U);
}

TEST(WriteFile, FolderInsteadOfFileIsRefused) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "b.png");
  EXPECT_THROW(check_writable(folder.path() / "b.png"), InputError);
  EXPECT_THROW(write_file(folder.path() / "b.png", "x"), InputError);
}

TEST(WriteFile, FolderWithoutRightsIsRefused) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const TemporaryFolder folder;
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THROW(check_writable(folder.path() / "a.png"), InputError);
  fs::permissions(folder.path(), fs::perms::owner_all);
}

TEST(WriteFile, FolderOfTheKernelIsRefused) {
  EXPECT_THROW(check_writable("/proc/self/a.png"), InputError);
}

TEST(CheckWritable, LeavesNothingAndKeepsWhatIsThere) {
  const TemporaryFolder folder;
  check_writable(folder.path() / "new.exr");
  EXPECT_EQ(folder.files(), 0U);
  write_file(folder.path() / "old.png", "old");
  check_writable(folder.path() / "old.png");
  EXPECT_EQ(read_file(folder.path() / "old.png", kMost), bytes_of("old"));
  EXPECT_EQ(folder.files(), 1U);
}

TEST(CheckWritable, UnknownExtensionIsUsage) {
  for (const char* name : {"a.jpg", "a", ".png.", "png"})
    EXPECT_THAT(message_of<UsageError>([&] { check_writable(name); }), HasSubstr(".png, .exr or .pfm")) << name;
}

TEST(WritePicture, RefusesAnEmptyPicture) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_picture(Picture{}, folder.path() / "a.png"), InputError);
}

TEST(ReadFile, RefusesMoreThanAllowed) {
  const TemporaryFolder folder;
  write_file(folder.path() / "a", std::string(100, 'x'));
  EXPECT_EQ(read_file(folder.path() / "a", 100).size(), 100U);
  EXPECT_THROW(read_file(folder.path() / "a", 99), InputError);
}

}  // namespace
}  // namespace torolux
