// SPDX-License-Identifier: MIT
// A launcher as a child process: words enter, its wait status leaves.
#pragma once

#include <sys/types.h>

#include <csignal>
#include <optional>
#include <string>
#include <vector>

namespace torolux::launch {

/// In a process group of its own, so that the terminal's Ctrl-C reaches this process alone; told to end (SIGTERM) where
/// this process dies. Killed with its group and reaped at the end of its life if it still runs.
class LauncherProcess {
 public:
  /// words: the first is looked up in PATH. mask: the child's. It has this process's standard output and errors, and
  /// its standard input where that is no terminal: a group in the background that reads from one is stopped.
  /// Throws InputError: it cannot be started.
  LauncherProcess(const std::vector<std::string>& words, const std::vector<std::string>& environment,
                  const sigset_t& mask);
  LauncherProcess(const LauncherProcess&) = delete;
  LauncherProcess& operator=(const LauncherProcess&) = delete;
  ~LauncherProcess();

  /// As of waitpid; absent while it runs.
  std::optional<int> poll();
  /// To the launcher alone.
  void signal(int number) const;
  /// SIGKILL, to its whole group.
  void kill_group() const;

 private:
  pid_t process_ = -1;
  std::optional<int> status_;
};

}  // namespace torolux::launch
