// SPDX-License-Identifier: MIT
// The three ways in which Torolux fails; each has its exit code.
#pragma once

#include <stdexcept>
#include <string>

namespace torolux {

enum class ExitCode : int { done = 0, usage = 1, bad_input = 2, machine_failure = 3 };

/// The user's input is wrong. The message says what, where (file and line), what is allowed and what to do.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The command line is wrong.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The machine failed: a trap, a dead engine process, a deadlock. The message names the PE.
class MachineFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The user has ended the run: nothing failed.
class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The same, and its state has been saved.
class StateSaved : public Interrupted {
 public:
  using Interrupted::Interrupted;
};

}  // namespace torolux
