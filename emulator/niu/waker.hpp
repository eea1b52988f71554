// SPDX-License-Identifier: MIT
// Who is told that a processor of this process may go on. Processors in processes of their own sleep on their channel.
#pragma once

namespace torolux {

class ProcessorWaker {
 public:
  virtual ~ProcessorWaker() = default;
  /// What this PE waits for may have come: its HINT is to be tried again. By the scheduler's thread.
  virtual void wake(unsigned pe) = 0;
};

}  // namespace torolux
