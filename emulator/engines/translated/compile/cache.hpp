// SPDX-License-Identifier: MIT
// Shared objects by the digest of all that they were made from. What is damaged, cut short or changed, or lies where
// others may change it, is never used.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "emulator/engines/translated/compile/private_folder.hpp"

namespace torolux::translated {

/// SHA-256 in hexadecimal.
std::string digest(std::string_view bytes);

/// A folder of its own for temporary files, removed with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

class Cache {
 public:
  using Tell = std::function<void(const std::string& line)>;

  /// folder: empty for $XDG_CACHE_HOME/torolux/translated, or .cache below $HOME. Made where it is not there. One that
  /// others may change is left alone, which `tell` is told (empty: standard error, once for each process and folder);
  /// then, and where it cannot be made, torolux-USER in the folder for temporary files takes its place. Where that is
  /// not the user's own either, nothing is kept.
  explicit Cache(std::filesystem::path folder, const Tell& tell = {});

  /// The object of this key, whose digest has just been checked: what is open can no longer be changed by others.
  std::optional<OpenFile> find(const std::string& key) const;
  /// Copies a file to its place. Does nothing where the folder cannot be written.
  void store(const std::string& key, const std::filesystem::path& file) const;

 private:
  /// Takes the folder where it is the user's own; else says what others could do, or nothing if it is just not there.
  std::string take(const std::filesystem::path& folder);

  std::optional<PrivateFolder> folder_;
};

}  // namespace torolux::translated
