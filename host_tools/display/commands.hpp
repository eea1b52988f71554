// SPDX-License-Identifier: MIT
// What a page asks of the run: commands enter from the server's threads, the run's thread takes them when it has time.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace torolux {

/// Whoever has asked waits for this, or has given up.
class Answer {
 public:
  void give(std::string json);
  /// Empty: nobody has answered in time.
  std::string wait_for(std::chrono::milliseconds patience);

 private:
  std::mutex mutex_;
  std::condition_variable given_;
  std::string json_;
};

/// A command that pages may give. Another one is added here and in docs/display.md; whoever takes it out of the queue
/// does what it says, and checks its values.
struct CommandName {
  std::string_view name;
  bool answered;  ///< the page waits for what the run's thread says to it
};
inline constexpr std::array kCommandNames = {
    CommandName{"ask", true},    ///< after a render: about an element, a PE, a pixel (questions.hpp)
    CommandName{"end", false},   ///< no more display: the run is stopped, or once it is over the command ends
    CommandName{"pace", false},  ///< while it runs: slow motion, single steps
    CommandName{"view", false},  ///< after the run: the scene from elsewhere
};

struct DisplayCommand {
  std::string name;                ///< one of kCommandNames
  nlohmann::json values;           ///< the whole object: {"do": name, ...}
  std::shared_ptr<Answer> answer;  ///< null unless answered
};

/// Null: there is no such command.
const CommandName* find_command(std::string_view name);

class CommandQueue {
 public:
  static constexpr std::size_t kMostWaiting = 64;

  /// False: too many wait already.
  bool put(DisplayCommand command);
  /// In the order in which they came. Waits up to `patience` for one.
  std::optional<DisplayCommand> take(std::chrono::milliseconds patience = std::chrono::milliseconds{0});

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  std::deque<DisplayCommand> waiting_;
};

}  // namespace torolux
