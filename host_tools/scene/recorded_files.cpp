// SPDX-License-Identifier: MIT
// Reads as asked, and notes each path when it is first read, with the SHA-256 of its bytes.
#include "host_tools/scene/recorded_files.hpp"

#include <algorithm>

namespace torolux {

std::string RecordedFiles::read(const std::filesystem::path& path, const Place& asked_at, std::uintmax_t most_bytes) {
  std::string text = disk_.read(path, asked_at, most_bytes);
  const std::string name = path.string();
  if (std::ranges::find(files_, name, &InputFile::path) == files_.end())
    files_.push_back({"scene", name, sha256(text)});
  return text;
}

}  // namespace torolux
