// SPDX-License-Identifier: MIT
// Scene files from disk, with a list of what was read: paths and digests.
#pragma once

#include <vector>

#include "host_tools/files/digest.hpp"
#include "host_tools/scene/files.hpp"

namespace torolux {

class RecordedFiles final : public SceneFiles {
 public:
  std::string read(const std::filesystem::path& path, const Place& asked_at, std::uintmax_t most_bytes) override;
  bool exists(const std::filesystem::path& path) override { return disk_.exists(path); }
  std::vector<std::string> names_in(const std::filesystem::path& folder) override { return disk_.names_in(folder); }

  /// Each file once, in the order in which they were first read; role "scene".
  const std::vector<InputFile>& files() const { return files_; }

 private:
  DiskFiles disk_;
  std::vector<InputFile> files_;
};

}  // namespace torolux
