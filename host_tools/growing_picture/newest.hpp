// SPDX-License-Identifier: MIT
// One value between two threads: the newest. Who gives never waits; who takes misses what it has no time for.
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <utility>

namespace torolux {

template <class Value>
class Newest {
 public:
  void put(std::shared_ptr<const Value> value) {
    const std::lock_guard lock(mutex_);
    value_ = std::move(value);
    changed_.notify_all();
  }

  /// What has been put since the last call; null: nothing, for so long or until it was closed.
  std::shared_ptr<const Value> take(std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, longest, [this] { return value_ != nullptr || closed_; });
    return std::exchange(value_, nullptr);
  }

  /// Nothing more will be put.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }
  bool closed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<const Value> value_;
  bool closed_ = false;
};

}  // namespace torolux
