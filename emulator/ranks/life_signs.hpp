// SPDX-License-Identifier: MIT
// Messages enter and leave again, but for signs of life: who is silent for too long is lost.
#pragma once

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <vector>

#include "emulator/ranks/transport.hpp"

namespace torolux::ranks {

struct LifeTimes {
  std::chrono::milliseconds between{1000};  ///< signs that are sent
  std::chrono::milliseconds silence{8000};  ///< after so long without a message a rank counts as lost
};

/// Sends signs of life to `peers`, by a thread of its own, so that who computes for long is not taken for dead; and
/// listens for theirs. A process that was stopped is silent: neither its threads nor its clock go on.
class LifeSigns {
 public:
  LifeSigns(Transport& transport, const std::vector<unsigned>& peers, LifeTimes times = {});
  LifeSigns(const LifeSigns&) = delete;
  LifeSigns& operator=(const LifeSigns&) = delete;
  ~LifeSigns() = default;

  /// The transport's next message that is no sign of life. Time counts as a peer's silence only where this is called
  /// and finds nothing, and up to an eighth of LifeTimes::silence at once: who was busy or stopped itself does not
  /// blame the others for that.
  std::optional<Message> poll();
  /// A rank that is heard again is not silent any more.
  bool silent(unsigned peer) const { return silence_.at(peer) >= times_.silence; }
  std::vector<unsigned> silent_ones() const;

 private:
  using Clock = std::chrono::steady_clock;

  void send_signs(const std::stop_token& stop, const std::vector<unsigned>& peers);

  Transport& transport_;
  LifeTimes times_;
  std::map<unsigned, Clock::duration> silence_;
  Clock::time_point looked_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable_any ended_;
  std::jthread sender_;  ///< the last member: it uses the others
};

}  // namespace torolux::ranks
