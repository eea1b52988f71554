// SPDX-License-Identifier: MIT
// The cache of translated code: used when it is whole, rebuilt when it is not, harmless where it cannot be written.
#include "emulator/engines/translated/compile/cache.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "emulator/engines/translated/run/translated_image.hpp"
#include "tests/translated/runs.hpp"

namespace torolux::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using translated::Cache;
using translated::TemporaryFolder;
using translated::TranslatedImage;

std::string contents_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}
void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

unsigned mode_of(const std::filesystem::path& file) {
  struct stat status {};
  return lstat(file.c_str(), &status) == 0 ? status.st_mode & 07777U : 0;
}

Image small_image() {
  Code code;
  code << addi(5, 5, 1) << hint(protocol::Hint::halt);
  return image_of(code);
}

std::filesystem::path only_object_in(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".so") return entry.path();
  }
  return {};
}

/// Folders for temporary files are made below this one while it lives.
class OwnTemporaryFiles {
 public:
  explicit OwnTemporaryFiles(const std::filesystem::path& folder) {
    setenv("TMPDIR", folder.c_str(), 1);  // NOLINT(concurrency-mt-unsafe): the test's only thread
  }
  ~OwnTemporaryFiles() { unsetenv("TMPDIR"); }  // NOLINT(concurrency-mt-unsafe)
  OwnTemporaryFiles(const OwnTemporaryFiles&) = delete;
  OwnTemporaryFiles& operator=(const OwnTemporaryFiles&) = delete;
};

bool comes_from_cache(const std::filesystem::path& folder, const LatencyTable& latency = {1, 2, 3}) {
  return TranslatedImage(small_image(), latency, {folder, false}).from_cache();
}

TEST(TranslationCache, ServesTheSecondTime) {
  const TemporaryFolder folder;
  EXPECT_FALSE(comes_from_cache(folder.path()));
  EXPECT_TRUE(comes_from_cache(folder.path()));
}

TEST(TranslationCache, KeepsLatencyTablesApart) {
  const TemporaryFolder folder;
  EXPECT_FALSE(comes_from_cache(folder.path(), {1, 2, 3}));
  EXPECT_FALSE(comes_from_cache(folder.path(), {7, 2, 3}));
}

TEST(TranslationCache, NeverUsesADamagedEntry) {
  const TemporaryFolder folder;
  ASSERT_FALSE(comes_from_cache(folder.path()));
  const std::filesystem::path object = only_object_in(folder.path());
  const std::string whole = contents_of(object);
  std::string flipped = whole;
  flipped[flipped.size() / 2] = static_cast<char>(flipped[flipped.size() / 2] ^ 1);
  for (const std::string& damaged : {std::string(), whole.substr(0, whole.size() - 1), whole + 'x', flipped}) {
    write(object, damaged);
    EXPECT_FALSE(comes_from_cache(folder.path()));
    EXPECT_TRUE(comes_from_cache(folder.path())) << "it has been rebuilt";
  }
  std::filesystem::remove(std::filesystem::path(object).replace_extension(".sha256"));
  EXPECT_FALSE(comes_from_cache(folder.path()));
}

TEST(TranslationCache, TwoAtOnceDoNoHarm) {
  const TemporaryFolder folder;
  std::thread other([&] { comes_from_cache(folder.path()); });
  comes_from_cache(folder.path());
  other.join();
  EXPECT_TRUE(comes_from_cache(folder.path()));
}

TEST(TranslationCache, DoesWithoutAFolderThatCannotBeMade) {
  const TemporaryFolder folder;
  const OwnTemporaryFiles elsewhere(folder.path());
  write(folder.path() / "file", "no folder");
  EXPECT_FALSE(comes_from_cache(folder.path() / "file" / "cache"));
  EXPECT_EQ(contents_of(folder.path() / "file"), "no folder");
}

// What others may have put there is neither run nor touched; code is kept in a private folder instead.
TEST(TranslationCache, LeavesAloneWhatOthersMayWriteTo) {
  const TemporaryFolder folder;
  const OwnTemporaryFiles elsewhere(folder.path());
  const std::filesystem::path open_to_all = folder.path() / "cache";
  ASSERT_FALSE(comes_from_cache(open_to_all));
  ASSERT_TRUE(comes_from_cache(open_to_all));
  chmod(open_to_all.c_str(), 0777);
  const std::filesystem::path object = only_object_in(open_to_all);
  const auto written = std::filesystem::last_write_time(object);
  EXPECT_FALSE(comes_from_cache(open_to_all));
  EXPECT_EQ(std::filesystem::last_write_time(object), written);
  EXPECT_EQ(mode_of(open_to_all), 0777U);
  EXPECT_TRUE(comes_from_cache(open_to_all)) << "from the private folder";
  EXPECT_EQ(mode_of(folder.path() / ("torolux-" + std::to_string(geteuid()))), 0700U);
}

TEST(TranslationCache, TellsWhatItLeavesAloneAndWhy) {
  const TemporaryFolder folder;
  const OwnTemporaryFiles elsewhere(folder.path());
  std::filesystem::create_directory(folder.path() / "cache");
  chmod((folder.path() / "cache").c_str(), 0777);
  std::string told;
  const auto tell = [&told](const std::string& line) { told += line; };
  const Cache cache(folder.path() / "cache", tell);
  EXPECT_THAT(told, AllOf(HasSubstr("cache may be written to by others (mode 0777)"), HasSubstr("torolux-"),
                          HasSubstr("is used")));
  told.clear();
  const Cache own(folder.path() / "own", tell);
  const Cache nowhere("/dev/null/cache", tell);
  EXPECT_EQ(told, "");
}

TEST(TranslationCache, KeepsNothingWhereNoFolderIsItsOwn) {
  const TemporaryFolder folder;
  const std::filesystem::path open_to_all = folder.path() / "all";
  std::filesystem::create_directory(open_to_all);
  chmod(open_to_all.c_str(), 0777);
  const OwnTemporaryFiles elsewhere(open_to_all);
  std::string told;
  const Cache cache(open_to_all / "cache", [&told](const std::string& line) { told += line; });
  write(folder.path() / "object", "code");
  cache.store("key", folder.path() / "object");
  EXPECT_FALSE(cache.find("key").has_value());
  EXPECT_THAT(told, HasSubstr("it is translated each time"));
}

// FIPS 180-2, appendix B.1.
TEST(TranslationCache, DigestIsSha256) {
  EXPECT_EQ(translated::digest("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace torolux::test
