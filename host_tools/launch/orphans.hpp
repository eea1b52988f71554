// SPDX-License-Identifier: MIT
// What ranks and launchers that were killed leave behind enters; nothing leaves.
#pragma once

namespace torolux::launch {

/// While it lives, descendants of this process whose parent has ended become its children.
class Orphans {
 public:
  Orphans();
  Orphans(const Orphans&) = delete;
  Orphans& operator=(const Orphans&) = delete;
  ~Orphans();

  /// Kills and reaps all children of this process, and theirs.
  static void end();
};

}  // namespace torolux::launch
