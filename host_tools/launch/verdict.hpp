// SPDX-License-Identifier: MIT
// What ranks and their launcher have said enters; how the whole run has ended leaves.
#pragma once

#include <sys/types.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "emulator/errors.hpp"
#include "host_tools/launch/rank_links.hpp"

namespace torolux::launch {

/// The first that matters counts, since everything after it may be its consequence.
class Verdict {
 public:
  explicit Verdict(unsigned ranks) : ranks_(ranks) {}

  void take(const RankEvent& event);
  /// This process was told to end, and has told rank 0. Whoever told it may have told ranks and launcher as well.
  void ask_to_end();
  /// This process was told to end, and no rank can be told to do so in order.
  void interrupt();
  /// Nothing can change it, but for a last word of rank 0.
  bool settled() const { return exit_code_.has_value() || interrupted_; }
  /// Whether a rank was lost, or has told of a failure: nothing is left to be written.
  bool failed() const { return exit_code_ == static_cast<int>(ExitCode::machine_failure); }
  /// launcher: its wait status; command: its words, for a message. Throws Interrupted; MachineFailure: a rank was lost,
  /// and is named, or the launcher has not come so far.
  int exit_code(int launcher, const std::vector<std::string>& command) const;
  /// What the user should know where exit_code throws no failure; empty: nothing.
  std::string note(int launcher) const;

 private:
  struct Rank {
    pid_t process = 0;
    bool has_ended = false;  ///< as it said
  };

  void lose(const RankEvent& event);
  [[noreturn]] void blame_launcher(int status, const std::vector<std::string>& command) const;

  unsigned ranks_;
  std::map<unsigned, Rank> here_;  ///< that have begun on this computer
  std::optional<int> exit_code_;
  bool of_rank_0_ = false;  ///< exit_code_ is
  bool asked_ = false;      ///< to end, before anything was lost
  bool interrupted_ = false;
  std::string lost_;  ///< the first rank that was, and how; empty: none
};

}  // namespace torolux::launch
