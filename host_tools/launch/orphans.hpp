// SPDX-License-Identifier: MIT
// What ranks and launchers that were killed leave behind enters; nothing leaves.
#pragma once

#include <sys/types.h>

#include <vector>

namespace torolux::launch {

/// While it lives, descendants of this process whose parent has ended become its children.
class Orphans {
 public:
  Orphans();
  Orphans(const Orphans&) = delete;
  Orphans& operator=(const Orphans&) = delete;
  ~Orphans();

  /// Kills and reaps all children of this process, and theirs, but for those that were there before: a shell's in the
  /// background, which a process keeps that the shell has made of itself (exec).
  void end() const;

 private:
  std::vector<pid_t> before_;
};

}  // namespace torolux::launch
