// SPDX-License-Identifier: MIT
// A thread for each connection, up to a limit: work enters, and is done beside the run; beyond the limit it is done at
// once, and is told to refuse.
#pragma once

#include <httplib.h>

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>

namespace torolux {

class ConnectionThreads final : public httplib::TaskQueue {
 public:
  static constexpr std::size_t kMost = 128;

  void enqueue(std::function<void()> work) override;
  /// Waits for all.
  void shutdown() override;

  /// In work: there are too many connections, this one is to be closed.
  static bool refusing();

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  std::size_t running_ = 0;
};

}  // namespace torolux
