// SPDX-License-Identifier: MIT
// One child process that cannot outlive us, with its output kept in memory for error messages.
#pragma once

#include <sys/types.h>

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "emulator/engines/engine/shared_memory.hpp"

namespace torolux {

class QemuProcess {
 public:
  /// Starts arguments[0] (found on PATH) in its own process group, so that a terminal's Ctrl-C reaches us alone. It is
  /// killed when the calling thread ends, however that ends.
  /// inherited: descriptors that stay open in it, under the same numbers. cores: host cores it may use; empty: all.
  /// Throws MachineFailure.
  QemuProcess(const std::vector<std::string>& arguments, std::span<const int> inherited, std::span<const int> cores);
  QemuProcess(QemuProcess&& other) noexcept;
  QemuProcess(const QemuProcess&) = delete;
  QemuProcess& operator=(const QemuProcess&) = delete;
  QemuProcess& operator=(QemuProcess&&) = delete;
  ~QemuProcess();

  /// Why it no longer runs ("killed by signal 9 (Killed)"), or nothing while it does. Does not wait.
  std::optional<std::string> ended();
  void kill();
  double cpu_seconds() const;
  /// The last lines that it wrote.
  std::string log_tail() const;

 private:
  void reap(int options);

  pid_t process_ = -1;  ///< -1 once it is gone
  int log_ = -1;
  int status_ = 0;  ///< as by wait
  bool stopped_ = false;
  double final_cpu_seconds_ = 0;
};

}  // namespace torolux
