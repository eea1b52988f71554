// SPDX-License-Identifier: MIT
// A folder and files that others could change are refused; what is made is closed to them. As root and as any user.
#include "emulator/engines/translated/compile/private_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "emulator/engines/translated/compile/cache.hpp"

namespace torolux::test {
namespace {

using ::testing::HasSubstr;
using translated::PrivateFolder;
using translated::TemporaryFolder;

constexpr uid_t kSomebodyElse = 65534;

unsigned mode_of(const std::filesystem::path& file) {
  struct stat status {};
  return lstat(file.c_str(), &status) == 0 ? status.st_mode & 07777U : 0;
}

bool opens(const std::filesystem::path& folder) {
  return std::holds_alternative<PrivateFolder>(PrivateFolder::open(folder));
}

/// Why the folder is not trusted; nothing where it is, or is just not there.
std::string doubt(const std::filesystem::path& folder) {
  const auto opened = PrivateFolder::open(folder);
  const auto* refusal = std::get_if<PrivateFolder::Refusal>(&opened);
  return refusal != nullptr && refusal->untrusted ? refusal->why : std::string();
}

std::filesystem::path folder_with_mode(const std::filesystem::path& folder, mode_t mode) {
  std::filesystem::create_directories(folder);
  chmod(folder.c_str(), mode);
  return folder;
}

PrivateFolder opened(const std::filesystem::path& folder) {
  return std::get<PrivateFolder>(PrivateFolder::open(folder));
}

TEST(PrivateFolder, IsMadeForTheUserAloneWhateverTheMask) {
  const TemporaryFolder folder;
  const mode_t before = umask(0);
  const bool made = opens(folder.path() / "above" / "cache");
  const PrivateFolder cache = opened(folder.path() / "above" / "cache");
  const bool written = cache.replace("file", "text");
  umask(before);
  ASSERT_TRUE(made && written);
  EXPECT_EQ(mode_of(folder.path() / "above"), 0700U);
  EXPECT_EQ(mode_of(folder.path() / "above" / "cache"), 0700U);
  EXPECT_EQ(mode_of(folder.path() / "above" / "cache" / "file"), 0600U);
}

TEST(PrivateFolder, ClosesWhatOthersCouldOnlyRead) {
  const TemporaryFolder folder;
  EXPECT_TRUE(opens(folder_with_mode(folder.path() / "cache", 0755)));
  EXPECT_EQ(mode_of(folder.path() / "cache"), 0700U);
}

TEST(PrivateFolder, RefusesWhatOthersMayWriteTo) {
  const TemporaryFolder folder;
  for (const mode_t mode : {0777U, 0770U, 0702U, 01777U}) {
    const auto open_to_all = folder_with_mode(folder.path() / "cache", mode);
    EXPECT_THAT(doubt(open_to_all), HasSubstr("may be written to by others"));
    EXPECT_EQ(mode_of(open_to_all), mode) << "left alone";
  }
}

// Root gives a folder away; any other user meets one of root's.
TEST(PrivateFolder, RefusesWhatBelongsToAnother) {
  const TemporaryFolder folder;
  const auto given = folder_with_mode(folder.path() / "cache", 0700);
  const bool is_root = geteuid() == 0;
  if (is_root) {
    ASSERT_EQ(chown(given.c_str(), kSomebodyElse, kSomebodyElse), 0);
  }
  EXPECT_THAT(doubt(is_root ? given : std::filesystem::path("/usr")), HasSubstr("belongs to user"));
  if (is_root) {
    EXPECT_THAT(doubt(given / "below"), HasSubstr("belongs to user")) << "above, only root is trusted";
  }
}

TEST(PrivateFolder, RefusesWhatOthersMayPutAnotherInPlaceOf) {
  const TemporaryFolder folder;
  const auto above = folder_with_mode(folder.path() / "above", 0777);
  const auto cache = folder_with_mode(above / "cache", 0700);
  EXPECT_THAT(doubt(cache), HasSubstr("above may be written to by others (mode 0777)"));
  std::filesystem::create_directory_symlink(cache, folder.path() / "link");
  EXPECT_THAT(doubt(folder.path() / "link"), HasSubstr("above may be written to by others"));
  chmod(above.c_str(), 01777);
  EXPECT_TRUE(opens(cache)) << "sticky: others cannot rename it";
}

TEST(PrivateFolder, SaysNothingOfWhatIsNotThere) {
  EXPECT_FALSE(opens("/dev/null/cache"));
  EXPECT_EQ(doubt("/dev/null/cache"), "");
}

TEST(PrivateFolder, ReadsOnlyPlainFilesOfTheUser) {
  const TemporaryFolder folder;
  const PrivateFolder cache = opened(folder.path());
  ASSERT_TRUE(cache.replace("file", "text"));
  EXPECT_EQ(cache.read("file"), "text");
  std::filesystem::create_symlink("file", folder.path() / "link");
  EXPECT_EQ(cache.read("link"), std::nullopt);
  ASSERT_EQ(mkfifo((folder.path() / "fifo").c_str(), 0600), 0);
  EXPECT_EQ(cache.read("fifo"), std::nullopt);
  chmod((folder.path() / "file").c_str(), 0622);
  EXPECT_EQ(cache.read("file"), std::nullopt);
  chmod((folder.path() / "file").c_str(), 0644);
  EXPECT_EQ(cache.read("file"), "text");
  if (geteuid() == 0) {
    ASSERT_EQ(chown((folder.path() / "file").c_str(), kSomebodyElse, kSomebodyElse), 0);
    EXPECT_EQ(cache.read("file"), std::nullopt);
  }
}

// A link that lies where the file is to be is replaced, never followed.
TEST(PrivateFolder, ReplacesALinkNotWhatItPointsTo) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "precious") << "keep";
  const PrivateFolder cache = opened(folder.path() / "cache");
  std::filesystem::create_symlink("../precious", folder.path() / "cache" / "file");
  ASSERT_TRUE(cache.replace("file", "text"));
  EXPECT_EQ(cache.read("file"), "text");
  EXPECT_EQ(std::filesystem::file_size(folder.path() / "precious"), 4U);
}

}  // namespace
}  // namespace torolux::test
