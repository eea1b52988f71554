// SPDX-License-Identifier: MIT
// A run enters, its key leaves: what would give the same result has the same key, whatever it is called and wherever it
// lies.
#pragma once

#include <string>
#include <vector>

#include "host_tools/study/points.hpp"

namespace torolux::study {

/// What a run is done with, and the name of its result.
struct KeyedRun {
  std::vector<std::string> words;  ///< after `torolux`, without options of results and threads
  std::string key;                 ///< SHA-256, 64 hexadecimal digits
  std::string settings;            ///< JSON, as determining() leaves them; empty where the command has none
  double work = 0;                 ///< to be expected, in no unit: more takes longer
};

/// SHA-256 of the program that is running.
std::string program_digest();

/// SHA-256 over the program's digest, the settings as resolved (before the run), and the digests of all inputs with the
/// firmware; for a command without settings: over its options and the digests of files that they name.
/// Throws InputError or UsageError for a run that would be refused; the message begins with what asked for it.
KeyedRun keyed_run(const Plan& plan, const Point& point, const std::string& program);

}  // namespace torolux::study
