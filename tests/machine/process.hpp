// SPDX-License-Identifier: MIT
// The built `torolux` as a user starts it: arguments in; exit code, output and the processes it made out.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace torolux::test {

struct Finished {
  int exit_code;  ///< 128 + signal where it was killed
  std::string output;
  std::string errors;
  double seconds;
};

/// A running torolux; killed and reaped at the end of its life if it still runs.
class ToroluxProcess {
 public:
  explicit ToroluxProcess(const std::vector<std::string>& arguments);
  ToroluxProcess(const ToroluxProcess&) = delete;
  ToroluxProcess& operator=(const ToroluxProcess&) = delete;
  ~ToroluxProcess();

  /// Sends a signal to it alone. SIGINT: once it does something about that; one that still loads would just be gone.
  void signal(int number) const;
  /// Its child processes, as soon as there are `count` of them; fewer where that takes longer than ten seconds.
  std::vector<pid_t> children(std::size_t count) const;
  /// What it has written to standard error.
  std::string errors_so_far() const;
  /// Waits for the end.
  Finished wait();

 private:
  pid_t process_ = -1;
  int output_ = -1;
  int errors_ = -1;
  std::chrono::steady_clock::time_point begin_;
};

Finished run_torolux(const std::vector<std::string>& arguments);

/// Options of `render` and `lockstep` with which a scene takes a few seconds.
std::vector<std::string> small_render_options();

/// Whether the process executes anything; a zombie does not.
bool runs(pid_t process);
/// Waits up to thirty seconds until none of them runs.
bool all_gone(const std::vector<pid_t>& processes);

/// Of a whole file.
std::string contents(const std::filesystem::path& file);
/// Of a file that --stats wrote, without what depends on the computer.
nlohmann::json statistics(const std::filesystem::path& file);

}  // namespace torolux::test
