// SPDX-License-Identifier: MIT
// Reads scene files and folders from disk.
#include "host_tools/scene/files.hpp"

#include <algorithm>
#include <fstream>
#include <system_error>

namespace torolux {

std::string DiskFiles::read(const std::filesystem::path& path, const Place& asked_at, std::uintmax_t most_bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) refuse(asked_at, "there is no file '" + path.string() + "'");
  if (!std::filesystem::is_regular_file(status)) refuse(asked_at, "'" + path.string() + "' is not a file");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) refuse(asked_at, "cannot read '" + path.string() + "': " + error.message());
  if (size > most_bytes)
    refuse(asked_at, "'" + path.string() + "' has " + std::to_string(size) + " bytes; at most " +
                         std::to_string(most_bytes) + " are read");
  std::string text(static_cast<std::size_t>(size), '\0');
  std::ifstream stream(path, std::ios::binary);
  stream.read(text.data(), static_cast<std::streamsize>(size));
  if (!stream || stream.gcount() != static_cast<std::streamsize>(size))
    refuse(asked_at, "cannot read '" + path.string() + "'");
  return text;
}

bool DiskFiles::exists(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::exists(path, error);
}

std::vector<std::string> DiskFiles::names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  std::filesystem::directory_iterator entry(folder.empty() ? std::filesystem::path(".") : folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error))
    names.push_back(entry->path().filename().string());
  std::ranges::sort(names);
  return names;
}

}  // namespace torolux
