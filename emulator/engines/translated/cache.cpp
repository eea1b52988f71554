// SPDX-License-Identifier: MIT
// Files of the cache: written under other names, then renamed.
#include "emulator/engines/translated/cache.hpp"

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "emulator/errors.hpp"

namespace torolux::translated {
namespace {

std::filesystem::path default_folder() {
  // NOLINTBEGIN(concurrency-mt-unsafe): nothing here changes the environment
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  // NOLINTEND(concurrency-mt-unsafe)
  if (cache != nullptr && *cache == '/') return std::filesystem::path(cache) / "torolux" / "translated";
  if (home != nullptr && *home == '/') return std::filesystem::path(home) / ".cache" / "torolux" / "translated";
  return {};
}

std::optional<std::string> contents_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return stream.is_open() ? std::optional(text.str()) : std::nullopt;
}

/// A private copy of a file that nobody else can change.
std::optional<OpenFile> sealed_copy(const std::string& contents) {
  OpenFile copy(memfd_create("torolux-translated", MFD_CLOEXEC));
  for (std::size_t at = 0; at < contents.size();) {
    const ssize_t written = write(copy.descriptor(), contents.data() + at, contents.size() - at);
    if (written <= 0) return std::nullopt;
    at += static_cast<std::size_t>(written);
  }
  return copy;
}

/// False where it cannot be written; then nothing is left behind.
bool replace_file(const std::filesystem::path& file, const std::string& contents) {
  std::string name = file.string() + ".XXXXXX";
  const int descriptor = mkstemp(name.data());
  if (descriptor < 0) return false;
  close(descriptor);
  std::ofstream stream(name, std::ios::binary);
  stream << contents;
  stream.close();
  std::error_code error;
  if (stream) std::filesystem::rename(name, file, error);
  if (!stream || error) {
    std::filesystem::remove(name, error);
    return false;
  }
  return true;
}

}  // namespace

std::string digest(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> hash{};
  unsigned length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), hash.data(), &length, EVP_sha256(), nullptr) != 1) {
    throw MachineFailure("SHA-256 cannot be computed");
  }
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (unsigned i = 0; i < length; ++i) {
    text += kDigits[hash[i] >> 4U];
    text += kDigits[hash[i] & 15U];
  }
  return text;
}

OpenFile::OpenFile(OpenFile&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

OpenFile::~OpenFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "torolux-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw MachineFailure("cannot make " + name + ": " + std::strerror(errno));
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

Cache::Cache(std::filesystem::path folder) : folder_(folder.empty() ? default_folder() : std::move(folder)) {}

std::optional<OpenFile> Cache::find(const std::string& key) const {
  const auto contents = contents_of(object(key));
  const auto expected = contents_of(seal(key));
  if (!contents || !expected || digest(*contents) != *expected) return std::nullopt;
  return sealed_copy(*contents);
}

void Cache::store(const std::string& key, const std::filesystem::path& file) const {
  std::error_code ignored;
  std::filesystem::create_directories(folder_, ignored);
  const auto contents = contents_of(file);
  if (!contents || folder_.empty()) return;
  if (replace_file(object(key), *contents)) replace_file(seal(key), digest(*contents));
}

}  // namespace torolux::translated
