// SPDX-License-Identifier: MIT
// A queue of bounded length between two kinds of threads.
#include "host_tools/display/commands.hpp"

#include <algorithm>
#include <utility>

namespace torolux {

void Answer::give(std::string json) {
  {
    const std::scoped_lock lock(mutex_);
    json_ = std::move(json);
  }
  given_.notify_all();
}

std::string Answer::wait_for(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  given_.wait_for(lock, patience, [this] { return !json_.empty(); });
  return json_;
}

const CommandName* find_command(std::string_view name) {
  const auto* const found = std::find_if(kCommandNames.begin(), kCommandNames.end(),
                                         [name](const CommandName& one) { return one.name == name; });
  return found == kCommandNames.end() ? nullptr : found;
}

bool CommandQueue::put(DisplayCommand command) {
  {
    const std::scoped_lock lock(mutex_);
    if (waiting_.size() >= kMostWaiting) return false;
    waiting_.push_back(std::move(command));
  }
  came_.notify_all();
  return true;
}

std::optional<DisplayCommand> CommandQueue::take(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  came_.wait_for(lock, patience, [this] { return !waiting_.empty(); });
  if (waiting_.empty()) return std::nullopt;
  DisplayCommand command = std::move(waiting_.front());
  waiting_.pop_front();
  return command;
}

}  // namespace torolux
