// SPDX-License-Identifier: MIT
// Two places enter, the one that is there leaves.
#include "emulator/installed_file.hpp"

#include <system_error>

namespace torolux {

std::filesystem::path installed_file(const std::filesystem::path& installed, const std::filesystem::path& built) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  std::filesystem::path file = (folder / ".." / installed).lexically_normal();
  if (std::filesystem::exists(file, error)) return file;
  return (folder / built).lexically_normal();
}

}  // namespace torolux
