// SPDX-License-Identifier: MIT
// Scene files that live in memory, for tests and fuzzers.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "host_tools/scene/files.hpp"

namespace torolux {

class MemoryFiles final : public SceneFiles {
 public:
  explicit MemoryFiles(std::map<std::string, std::string> files) : files_(std::move(files)) {}

  std::string read(const std::filesystem::path& path, const Place& asked_at, std::uintmax_t most_bytes) override {
    const auto found = files_.find(path.string());
    if (found == files_.end()) refuse(asked_at, "there is no file '" + path.string() + "'");
    if (found->second.size() > most_bytes) refuse(asked_at, "'" + path.string() + "' is too long");
    return found->second;
  }
  bool exists(const std::filesystem::path& path) override { return files_.count(path.string()) > 0; }
  std::vector<std::string> names_in(const std::filesystem::path& folder) override {
    std::set<std::string> names;
    for (const auto& [name, bytes] : files_) {
      std::filesystem::path path = name;
      while (path.has_parent_path() && path.parent_path() != folder) path = path.parent_path();
      if (path.parent_path() == folder) names.insert(path.filename().string());
    }
    return {names.begin(), names.end()};
  }

 private:
  std::map<std::string, std::string> files_;
};

}  // namespace torolux
