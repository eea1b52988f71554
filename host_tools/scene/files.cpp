// SPDX-License-Identifier: MIT
// Reads scene files from disk; words the messages about places in them.
#include "host_tools/scene/files.hpp"

#include <fstream>
#include <system_error>

#include "emulator/errors.hpp"

namespace torolux {

void refuse(const Place& place, const std::string& message) {
  throw InputError(place.file.empty() ? message : place.text() + ": " + message);
}

void Notices::note(const std::string& message, const Place& place) {
  for (Notice& notice : notices_) {
    if (notice.message == message) {
      ++notice.count;
      return;
    }
  }
  notices_.push_back({message, place, 1});
}

std::vector<std::string> Notices::lines() const {
  std::vector<std::string> lines;
  for (const Notice& notice : notices_) {
    std::string line = notice.first.text() + ": " + notice.message;
    if (notice.count > 1) line += " (and " + std::to_string(notice.count - 1) + " more)";
    lines.push_back(std::move(line));
  }
  return lines;
}

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

}  // namespace torolux
