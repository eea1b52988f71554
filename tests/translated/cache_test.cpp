// SPDX-License-Identifier: MIT
// The cache of translated code: used when it is whole, rebuilt when it is not, harmless where it cannot be written.
#include "emulator/engines/translated/cache.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "emulator/engines/translated/translated_image.hpp"
#include "tests/translated/runs.hpp"

namespace torolux::test {
namespace {

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
  write(folder.path() / "file", "no folder");
  EXPECT_FALSE(comes_from_cache(folder.path() / "file" / "cache"));
  EXPECT_EQ(contents_of(folder.path() / "file"), "no folder");
}

// FIPS 180-2, appendix B.1.
TEST(TranslationCache, DigestIsSha256) {
  EXPECT_EQ(translated::digest("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace torolux::test
