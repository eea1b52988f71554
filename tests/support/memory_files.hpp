// SPDX-License-Identifier: MIT
// Scene files that live in memory, for tests and fuzzers.
#pragma once

#include <filesystem>
#include <map>
#include <string>

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

 private:
  std::map<std::string, std::string> files_;
};

}  // namespace torolux
