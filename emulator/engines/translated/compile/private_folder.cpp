// SPDX-License-Identifier: MIT
// Owners and modes of the folder and of all above it; files by descriptor, never through a link.
#include "emulator/engines/translated/compile/private_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <random>
#include <utility>

namespace torolux::translated {
namespace {

using Refusal = PrivateFolder::Refusal;

constexpr mode_t kWritableByOthers = S_IWGRP | S_IWOTH;
constexpr mode_t kForOthers = S_IRWXG | S_IRWXO;

std::string octal(mode_t mode) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "%04o", static_cast<unsigned>(mode & 07777U));
  return text.data();
}

std::string owner_of(const struct stat& status) {
  return "belongs to user " + std::to_string(status.st_uid) + ", not to user " + std::to_string(geteuid());
}

Refusal unavailable(const std::filesystem::path& folder, const char* what) {
  return {false, std::string(what) + " " + folder.string() + ": " + std::strerror(errno)};
}

/// What lets others rename what is in a folder: nothing, where its owner is the user or root, and nobody else may write
/// to it or a sticky bit keeps entries to their owners.
std::optional<Refusal> doubt_of_parent(const std::filesystem::path& folder) {
  struct stat status {};
  if (lstat(folder.c_str(), &status) != 0) return unavailable(folder, "cannot look at");
  if (status.st_uid != 0 && status.st_uid != geteuid()) return Refusal{true, folder.string() + " " + owner_of(status)};
  if ((status.st_mode & kWritableByOthers) != 0 && (status.st_mode & S_ISVTX) == 0) {
    return Refusal{true, folder.string() + " may be written to by others (mode " + octal(status.st_mode) + ")"};
  }
  return std::nullopt;
}

/// Mode 0700 for each that is made: under the user's mask alone it might be open to others.
std::optional<Refusal> make(const std::filesystem::path& folder) {
  std::filesystem::path made;
  for (const std::filesystem::path& part : folder) {
    made /= part;
    if (mkdir(made.c_str(), S_IRWXU) != 0 && errno != EEXIST && access(made.c_str(), F_OK) != 0) {
      return unavailable(made, "cannot make");
    }
  }
  return std::nullopt;
}

/// Mode 0600, for this process alone until it has its name.
OpenFile create_temporary(int folder, std::string& name) {
  std::random_device random;
  name += "." + std::to_string(getpid()) + "." + std::to_string(random());
  return OpenFile(
      openat(folder, name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR));
}

bool write_all(int descriptor, std::string_view contents) {
  while (!contents.empty()) {
    const ssize_t written = write(descriptor, contents.data(), contents.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    contents.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

OpenFile::OpenFile(OpenFile&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

OpenFile::~OpenFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::variant<PrivateFolder, Refusal> PrivateFolder::open(const std::filesystem::path& folder) {
  if (const auto refusal = make(folder)) return *refusal;
  std::error_code error;
  const std::filesystem::path resolved = std::filesystem::canonical(folder, error);
  if (error) return Refusal{false, "cannot resolve " + folder.string() + ": " + error.message()};
  for (auto parent = resolved; parent != parent.parent_path();) {
    parent = parent.parent_path();
    if (const auto doubt = doubt_of_parent(parent)) return *doubt;
  }
  OpenFile opened(::open(resolved.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  struct stat status {};
  if (opened.descriptor() < 0 || fstat(opened.descriptor(), &status) != 0) return unavailable(resolved, "cannot open");
  if (status.st_uid != geteuid()) return Refusal{true, resolved.string() + " " + owner_of(status)};
  if ((status.st_mode & kWritableByOthers) != 0) {
    return Refusal{true, resolved.string() + " may be written to by others (mode " + octal(status.st_mode) + ")"};
  }
  if ((status.st_mode & kForOthers) != 0 && fchmod(opened.descriptor(), S_IRWXU) != 0) {
    return unavailable(resolved, "cannot close to others");
  }
  return PrivateFolder(std::move(opened));
}

std::optional<std::string> PrivateFolder::read(const std::string& name) const {
  // Without O_NONBLOCK a FIFO would make this wait.
  const OpenFile file(openat(folder_.descriptor(), name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  struct stat status {};
  if (file.descriptor() < 0 || fstat(file.descriptor(), &status) != 0) return std::nullopt;
  if (!S_ISREG(status.st_mode) || status.st_uid != geteuid() || (status.st_mode & kWritableByOthers) != 0) {
    return std::nullopt;
  }
  std::string contents;
  std::array<char, 1 << 16> part{};
  for (;;) {
    const ssize_t bytes = ::read(file.descriptor(), part.data(), part.size());
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0) return std::nullopt;
    if (bytes == 0) return contents;
    contents.append(part.data(), static_cast<std::size_t>(bytes));
  }
}

bool PrivateFolder::replace(const std::string& name, std::string_view contents) const {
  std::string temporary = name;
  const OpenFile file = create_temporary(folder_.descriptor(), temporary);
  if (file.descriptor() < 0) return false;
  if (write_all(file.descriptor(), contents) &&
      renameat(folder_.descriptor(), temporary.c_str(), folder_.descriptor(), name.c_str()) == 0) {
    return true;
  }
  unlinkat(folder_.descriptor(), temporary.c_str(), 0);
  return false;
}

}  // namespace torolux::translated
