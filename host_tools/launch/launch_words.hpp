// SPDX-License-Identifier: MIT
// What `--ranks` and `--launcher` say enters; the launcher's command line and environment leave.
#pragma once

#include <string>
#include <vector>

namespace torolux::launch {

struct LaunchChoice {
  unsigned ranks = 1;
  std::string launcher;  ///< words between blanks; empty: mpirun of this build's MPI
};

/// words: of this command line, without the program; each rank gets them without `--ranks` and `--launcher`.
/// Throws UsageError: there is no launcher.
std::vector<std::string> launch_words(const LaunchChoice& choice, const std::string& program,
                                      const std::vector<std::string>& words);

/// This process's, with the name of the socket at which ranks find who has started them.
std::vector<std::string> launch_environment(const std::string& socket_name);

}  // namespace torolux::launch
