// SPDX-License-Identifier: MIT
// The files that a command reads and writes enter; nothing leaves, unless one would be written over another.
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace torolux {

struct NamedFile {
  std::string what;  ///< the option that names it, or what it is
  std::filesystem::path file;
};

/// Throws InputError where two of `written` are one file, or one of them is one of `read` (links followed). Devices and
/// pipes may be named twice.
void check_distinct(std::span<const NamedFile> written, std::span<const NamedFile> read);

}  // namespace torolux
