// SPDX-License-Identifier: MIT
// Orders enter, answers leave: each by a child process.
#pragma once

#include <list>
#include <string>

#include "host_tools/study/child.hpp"
#include "host_tools/study/hands.hpp"

namespace torolux::study {

class LocalHands : public Hands {
 public:
  /// program: what runs, a path. jobs: at once.
  LocalHands(std::string program, unsigned jobs, bool brings_results)
      : program_(std::move(program)), jobs_(jobs), brings_results_(brings_results) {}

  bool brings_results() const override { return brings_results_; }
  bool free() const override { return running_.size() < jobs_; }
  std::optional<pid_t> start(const Order& order) override;
  std::optional<Answer> poll() override;
  void stop() override;

 private:
  struct Running {
    std::uint64_t number;
    bool from_output;
    Child child;
  };

  std::string program_;
  unsigned jobs_;
  bool brings_results_;
  std::list<Running> running_;
};

/// This one, should its file have been replaced meanwhile.
std::string running_program();

}  // namespace torolux::study
