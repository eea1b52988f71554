// SPDX-License-Identifier: MIT
// Threads are counted, and the count waited for.
#include "host_tools/display/connection_threads.hpp"

#include <system_error>
#include <thread>
#include <utility>

namespace torolux {
namespace {

thread_local bool refuses = false;

}  // namespace

bool ConnectionThreads::refusing() {
  return refuses;
}

void ConnectionThreads::enqueue(std::function<void()> work) {
  {
    const std::scoped_lock lock(mutex_);
    if (running_ < kMost) {
      try {
        std::thread([this, work] {
          work();
          // Under the lock: after it, this may be gone.
          const std::scoped_lock end(mutex_);
          --running_;
          ended_.notify_all();
        }).detach();
        ++running_;
        return;
      } catch (const std::system_error&) {  // this computer has no more threads
      }
    }
  }
  refuses = true;
  work();
  refuses = false;
}

void ConnectionThreads::shutdown() {
  std::unique_lock lock(mutex_);
  ended_.wait(lock, [this] { return running_ == 0; });
}

}  // namespace torolux
