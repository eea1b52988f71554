// SPDX-License-Identifier: MIT
// Runs enter, result files leave: as child processes here and on other ranks, so many at once, each run by one process
// at a time.
#pragma once

#include <string>
#include <vector>

#include "host_tools/study/hands.hpp"
#include "host_tools/study/results.hpp"

namespace torolux::study {

struct Work {
  KeyedRun run;
  std::string label;
};

struct Failure {
  std::string label, command;
  int exit_code;
  std::string errors;
};

struct RunnerChoice {
  std::string program;        ///< how a message names it
  unsigned threads = 1;       ///< of a run
  std::vector<Hands*> hands;  ///< who does it; the first that are free are asked first
};

struct RunnerEnd {
  std::size_t started = 0;  ///< runs
  std::size_t others = 0;   ///< results that other processes made meanwhile
  std::vector<Failure> failures;
  bool interrupted = false;
};

/// Does all work whose result is not there, the longest first; what another process has claimed is waited for. Failures
/// are told on standard error as they come. Ends early where the program is interrupted.
RunnerEnd run_all(std::vector<Work> work, const ResultFolder& folder, const RunnerChoice& choice);

}  // namespace torolux::study
