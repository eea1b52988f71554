// SPDX-License-Identifier: MIT
// Which folder it is, and what lies there.
#include "emulator/engines/translated/compile/cache.hpp"

#include <openssl/evp.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <mutex>
#include <set>
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

std::filesystem::path folder_for_temporary_files() {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  return error ? std::filesystem::path("/tmp") : folder;
}

/// The line is written once, however many images are translated.
void tell_once(const std::string& line) {
  static std::mutex mutex;
  static std::set<std::string> told;
  const std::lock_guard lock(mutex);
  if (told.insert(line).second) std::cerr << "torolux: note: " << line << std::endl;
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

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "torolux-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw MachineFailure("cannot make " + name + ": " + std::strerror(errno));
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

Cache::Cache(std::filesystem::path folder, const Tell& tell) {
  if (folder.empty()) folder = default_folder();
  const std::string doubt = folder.empty() ? std::string() : take(folder);
  if (folder_) return;
  const std::filesystem::path instead = folder_for_temporary_files() / ("torolux-" + std::to_string(geteuid()));
  const std::string second_doubt = take(instead);
  if (doubt.empty() && second_doubt.empty()) return;
  (tell ? tell : tell_once)("translated code is not kept in " + (doubt.empty() ? instead : folder).string() +
                            ", where others could put theirs: " + (doubt.empty() ? second_doubt : doubt) +
                            (folder_ ? "; " + instead.string() + " is used" : "; it is translated each time") +
                            ". Make that folder yours alone (chown, chmod go-w), or remove it");
}

std::string Cache::take(const std::filesystem::path& folder) {
  auto opened = PrivateFolder::open(folder);
  if (auto* own = std::get_if<PrivateFolder>(&opened)) {
    folder_.emplace(std::move(*own));
    return {};
  }
  const auto& refusal = std::get<PrivateFolder::Refusal>(opened);
  return refusal.untrusted ? refusal.why : std::string();
}

std::optional<OpenFile> Cache::find(const std::string& key) const {
  if (!folder_) return std::nullopt;
  const auto contents = folder_->read(key + ".so");
  const auto expected = folder_->read(key + ".sha256");
  if (!contents || !expected || digest(*contents) != *expected) return std::nullopt;
  return sealed_copy(*contents);
}

void Cache::store(const std::string& key, const std::filesystem::path& file) const {
  if (!folder_) return;
  const auto contents = contents_of(file);
  if (contents && folder_->replace(key + ".so", *contents)) folder_->replace(key + ".sha256", digest(*contents));
}

}  // namespace torolux::translated
