// SPDX-License-Identifier: MIT
// Looks for files under names that programs on other computers have written.
#include "host_tools/scene/find_file.hpp"

#include <algorithm>

#include "host_tools/scene/statements.hpp"

namespace torolux {
namespace {

using std::filesystem::path;

/// The file below `folder` that has this name but for letter case; empty: none.
path in_other_case(const path& folder, const path& name, SceneFiles& files, const Place& place) {
  path found = folder;
  for (const path& part : name.lexically_normal()) {
    if (part == ".." || part == "/") {
      found /= part;
      continue;
    }
    std::vector<std::string> alike;
    for (const std::string& entry : files.names_in(found))
      if (equal_but_for_case(entry, part.string())) alike.push_back(entry);
    // The same letters are meant rather than others.
    if (std::ranges::find(alike, part.string()) != alike.end()) alike = {part.string()};
    if (alike.empty()) return {};
    if (alike.size() > 1)
      refuse(place, "there is no file " + in_quotes((folder / name).string()) + ", but " + in_quotes(alike[0]) +
                        " and " + in_quotes(alike[1]) + "; name one of them");
    found /= alike[0];
  }
  return found;
}

/// What follows the last slash, or the drive; empty where the name has neither.
std::string base_name(const std::string& name) {
  const std::size_t end = name.find_last_of("/:");
  return end == std::string::npos ? std::string() : name.substr(end + 1);
}

}  // namespace

std::vector<std::string> other_readings(const std::string& name) {
  std::vector<std::string> readings;
  const auto unquoted = [&readings](const std::string& text) {
    if (text.size() > 2 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front())
      readings.push_back(text.substr(1, text.size() - 2));
  };
  unquoted(name);
  const std::size_t comment = std::min(name.find(" #"), name.find("\t#"));
  if (comment == std::string::npos || comment == 0) return readings;
  readings.push_back(name.substr(0, name.find_last_not_of(" \t", comment) + 1));
  unquoted(readings.back());
  return readings;
}

std::optional<FoundFile> find_file(const std::string& written, std::span<const path> folders, SceneFiles& files,
                                   const Place& place) {
  std::string name = written;
  std::ranges::replace(name, '\\', '/');
  std::vector<std::string> readings = other_readings(name);
  readings.insert(readings.begin(), name);
  const auto exact = [&](const std::string& reading) -> path {
    for (const path& folder : folders)
      if (path found = (folder / reading).lexically_normal(); files.exists(found)) return found;
    return {};
  };
  const auto alike = [&](const std::string& reading) -> path {
    for (const path& folder : folders)
      if (path found = in_other_case(folder, reading, files, place); !found.empty()) return found.lexically_normal();
    return {};
  };
  for (const std::string& reading : readings)
    if (const path found = exact(reading); !found.empty()) return FoundFile{found, reading == name};
  for (const std::string& reading : readings)
    if (const path found = alike(reading); !found.empty()) return FoundFile{found, false};
  for (const std::string& reading : readings) {
    const std::string base = base_name(reading);
    if (base.empty()) continue;
    if (const path found = exact(base); !found.empty()) return FoundFile{found, false};
    if (const path found = alike(base); !found.empty()) return FoundFile{found, false};
  }
  return std::nullopt;
}

}  // namespace torolux
