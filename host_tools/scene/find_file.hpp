// SPDX-License-Identifier: MIT
// A file's name as another program wrote it, and folders, enter; the file that is meant leaves.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "host_tools/scene/files.hpp"

namespace torolux {

struct FoundFile {
  std::filesystem::path path;
  bool as_written;  ///< but for backslashes, which stand for slashes
};

/// In this order, each in all of `folders`: as written; without quotation marks, or a comment that follows (" #");
/// in another letter case; by its base name, where it has a path (which may be of another computer). Absent: nowhere.
/// Throws InputError where several files differ from it by letter case alone.
std::optional<FoundFile> find_file(const std::string& written, std::span<const std::filesystem::path> folders,
                                   SceneFiles& files, const Place& place);

/// What else a name may have been meant as, best first, without the name itself: without quotation marks around it,
/// without a comment after it.
std::vector<std::string> other_readings(const std::string& name);

}  // namespace torolux
