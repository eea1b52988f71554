// SPDX-License-Identifier: MIT
// The ending of a file's name, however it is written.
#pragma once

#include <cctype>
#include <filesystem>
#include <string>

namespace torolux {

/// With its point, in small letters; "" where there is none.
inline std::string small_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

}  // namespace torolux
