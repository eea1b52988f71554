// SPDX-License-Identifier: MIT
// Connections of ranks on this computer, and of their keepers, enter; that a rank begins, says how it ends, or has died
// leaves.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace torolux::launch {

struct RankEvent {
  enum class Kind { begins, ends, died, keeper_gone };

  Kind kind;
  unsigned rank;
  pid_t process;  ///< of the rank or its keeper, as this process sees it
  int status;     ///< ends: its exit code; died: as of waitpid
};

/// A socket that is no file, so that none is left behind; only processes of the same user are listened to.
class RankLinks {
 public:
  RankLinks();
  RankLinks(const RankLinks&) = delete;
  RankLinks& operator=(const RankLinks&) = delete;
  ~RankLinks();

  /// Of the socket (ranks::kStarterVariable).
  const std::string& name() const { return name_; }
  /// What has come, in the order in which it came; sleeps until something has, or `descriptor` is readable, `limit` at
  /// most.
  std::vector<RankEvent> wait(std::chrono::milliseconds limit);
  /// wait also ends where this is readable.
  void wake_by(int descriptor) const;

  /// Of a rank. None: it has not begun, is gone, or is on another computer.
  std::optional<pid_t> process_of(unsigned rank) const;
  /// Of ranks and keepers that are there.
  std::vector<pid_t> processes() const;

 private:
  struct Link {
    pid_t process = 0;
    std::optional<unsigned> rank;  ///< absent: it has not said yet
    bool keeper = false;
  };

  void accept();
  /// Of the connection; adds what it says.
  void read(int connection, std::vector<RankEvent>& events);

  std::string name_;
  int socket_ = -1, events_ = -1;
  std::map<int, Link> links_;  ///< by descriptor
};

}  // namespace torolux::launch
