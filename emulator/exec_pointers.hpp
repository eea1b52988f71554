// SPDX-License-Identifier: MIT
// Words of a command line or of an environment enter; what exec and posix_spawn take leaves.
#pragma once

#include <string>
#include <vector>

namespace torolux {

/// They point into `words`, and end with a null. Nothing is written through them: their type is that of a time before
/// const.
inline std::vector<char*> exec_pointers(const std::vector<std::string>& words) {
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace torolux
