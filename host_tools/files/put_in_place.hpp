// SPDX-License-Identifier: MIT
// A file without a name enters; it has one, in the place of what had it.
#pragma once

#include <filesystem>

namespace torolux {

struct PutInPlace {
  bool done = false;   ///< errno says why not
  bool named = false;  ///< the other name is left, and to be removed
};

/// path: of the open file, below /proc. name: one that no file has, in the target's folder. No call puts a file without
/// a name in another one's place; the two that do are made by a process of their own, so that who kills this one
/// between them, and not all of its group, leaves nothing of that name.
PutInPlace put_in_place(const std::filesystem::path& path, const std::filesystem::path& name,
                        const std::filesystem::path& target);

}  // namespace torolux
