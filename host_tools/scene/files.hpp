// SPDX-License-Identifier: MIT
// Where scene files come from, and how messages name a place in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace torolux {

/// A line of a file; 0: the file as a whole.
struct Place {
  std::string file;
  std::size_t line = 0;

  std::string text() const { return line == 0 ? file : file + ":" + std::to_string(line); }
};

/// Throws InputError "FILE:LINE: message".
[[noreturn]] void refuse(const Place& place, const std::string& message);

/// Warnings of one kind are told once, with the first place and how many more there were.
class Notices {
 public:
  void note(const std::string& message, const Place& place);
  std::vector<std::string> lines() const;  ///< in the order of their first places

 private:
  struct Notice {
    std::string message;
    Place first;
    std::size_t count;
  };
  std::vector<Notice> notices_;
};

/// Reads whole files. Tests and fuzzers hand in their own.
class SceneFiles {
 public:
  SceneFiles() = default;
  SceneFiles(const SceneFiles&) = delete;
  SceneFiles& operator=(const SceneFiles&) = delete;
  virtual ~SceneFiles() = default;

  /// Throws InputError: absent, not a regular file, unreadable, longer than most_bytes. asked_at: where it is named.
  virtual std::string read(const std::filesystem::path& path, const Place& asked_at, std::uintmax_t most_bytes) = 0;
  virtual bool exists(const std::filesystem::path& path) = 0;
};

class DiskFiles final : public SceneFiles {
 public:
  std::string read(const std::filesystem::path& path, const Place& asked_at, std::uintmax_t most_bytes) override;
  bool exists(const std::filesystem::path& path) override;
};

inline constexpr std::uintmax_t kMostMeshBytes = std::uintmax_t{1} << 30U;
inline constexpr std::uintmax_t kMostImageBytes = std::uintmax_t{256} << 20U;
inline constexpr std::uintmax_t kMostTextBytes = std::uintmax_t{4} << 20U;  ///< MTL and TOML

}  // namespace torolux
