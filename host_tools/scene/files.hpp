// SPDX-License-Identifier: MIT
// Paths enter; the bytes of scene files, and the names of what lies in a folder, leave.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host_tools/scene/notices.hpp"

namespace torolux {

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
  /// Of files and folders directly in `folder`, ascending; none where that is no folder.
  virtual std::vector<std::string> names_in(const std::filesystem::path& folder) = 0;
};

class DiskFiles final : public SceneFiles {
 public:
  std::string read(const std::filesystem::path& path, const Place& asked_at, std::uintmax_t most_bytes) override;
  bool exists(const std::filesystem::path& path) override;
  std::vector<std::string> names_in(const std::filesystem::path& folder) override;
};

inline constexpr std::uintmax_t kMostMeshBytes = std::uintmax_t{1} << 30U;
inline constexpr std::uintmax_t kMostImageBytes = std::uintmax_t{256} << 20U;
inline constexpr std::uintmax_t kMostTextBytes = std::uintmax_t{4} << 20U;  ///< MTL and TOML

}  // namespace torolux
