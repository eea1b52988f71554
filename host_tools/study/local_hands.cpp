// SPDX-License-Identifier: MIT
// A list of child processes.
#include "host_tools/study/local_hands.hpp"

#include <unistd.h>

#include <csignal>

namespace torolux::study {

std::string running_program() {
  return "/proc/" + std::to_string(::getpid()) + "/exe";
}

std::optional<pid_t> LocalHands::start(const Order& order) {
  const bool stream = brings_results_ && !order.from_output;
  Child child(program_, order.words, "", stream ? ResultStream::yes : ResultStream::no);
  const pid_t process = child.process();
  running_.push_back({order.number, order.from_output, std::move(child)});
  return process;
}

std::optional<Answer> LocalHands::poll() {
  for (auto one = running_.begin(); one != running_.end(); ++one) {
    std::optional<Ended> ended = one->child.poll();
    if (!ended) continue;
    std::string result = one->from_output ? std::move(ended->output) : std::move(ended->result);
    Answer answer{one->number, Outcome{ended->exit_code, std::move(ended->errors), std::move(result)}};
    running_.erase(one);
    return answer;
  }
  return std::nullopt;
}

void LocalHands::stop() {
  for (const Running& running : running_) running.child.signal(SIGTERM);
  for (Running& running : running_) running.child.wait();
  running_.clear();
}

}  // namespace torolux::study
