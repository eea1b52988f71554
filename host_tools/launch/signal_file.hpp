// SPDX-License-Identifier: MIT
// SIGINT, SIGTERM and SIGHUP as something to be read, one after the other.
#pragma once

#include <csignal>
#include <optional>

namespace torolux::launch {

/// While it lives, these signals do nothing but wait to be taken. One that is ignored already (nohup) still is.
class SignalFile {
 public:
  SignalFile();
  SignalFile(const SignalFile&) = delete;
  SignalFile& operator=(const SignalFile&) = delete;
  ~SignalFile();

  /// The next signal that has come; absent: none.
  std::optional<int> take() const;
  /// What is readable when one has come.
  int descriptor() const { return descriptor_; }
  /// The mask that was before: a child's.
  const sigset_t& before() const { return before_; }

 private:
  sigset_t before_{};
  int descriptor_ = -1;
};

}  // namespace torolux::launch
