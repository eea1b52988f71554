// SPDX-License-Identifier: MIT
// A compiler as a child process: words enter; its exit code leaves, and what it said.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace torolux {

struct CompilerEnd {
  int exit_code;       ///< 128 + signal where it was killed
  std::string errors;  ///< what it wrote to standard error, the last kMostKeptErrors of it
};
inline constexpr std::size_t kMostKeptErrors = std::size_t{1} << 20U;

/// Runs words[0], looked up in PATH, with this program's standard input and output. What it writes to standard error is
/// written to this program's at once, byte for byte, and kept.
/// Throws InputError where there is no such program, naming `package` as what to install.
CompilerEnd run_compiler(const std::vector<std::string>& words, const std::string& package);

}  // namespace torolux
