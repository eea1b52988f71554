// SPDX-License-Identifier: MIT
// Shared objects by the digest of all that they were made from. What is damaged, cut short or changed is never used.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace torolux::translated {

/// SHA-256 in hexadecimal.
std::string digest(std::string_view bytes);

/// An open file, closed with the object.
class OpenFile {
 public:
  explicit OpenFile(int descriptor) : descriptor_(descriptor) {}
  OpenFile(OpenFile&& other) noexcept;
  OpenFile& operator=(OpenFile&&) = delete;
  ~OpenFile();
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

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
  /// folder: empty for $XDG_CACHE_HOME/torolux/translated, or .cache below $HOME. Made when it is first needed.
  explicit Cache(std::filesystem::path folder);

  /// The object of this key, whose digest has just been checked: what is open can no longer be changed by others.
  std::optional<OpenFile> find(const std::string& key) const;
  /// Copies a file to its place. Does nothing where the folder cannot be written.
  void store(const std::string& key, const std::filesystem::path& file) const;

 private:
  std::filesystem::path object(const std::string& key) const { return folder_ / (key + ".so"); }
  std::filesystem::path seal(const std::string& key) const { return folder_ / (key + ".sha256"); }

  std::filesystem::path folder_;
};

}  // namespace torolux::translated
