// SPDX-License-Identifier: MIT
// Who is told that a processor may go on: one of this process, or of another rank. Processors in processes of their own
// sleep on their channel.
#pragma once

namespace torolux {

class ProcessorWaker {
 public:
  virtual ~ProcessorWaker() = default;
  /// What this PE waits for may have come: its HINT is to be tried again. By the scheduler's thread.
  virtual void wake(unsigned pe) = 0;
  /// Whether `told` is to be called.
  virtual bool is_far() const { return false; }
  /// Its channel holds something new for this PE, for which it need not be woken. By the scheduler's thread.
  virtual void told(unsigned /*pe*/) {}
};

}  // namespace torolux
