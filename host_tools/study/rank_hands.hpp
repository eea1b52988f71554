// SPDX-License-Identifier: MIT
// Rank 0's side of a study on many: orders enter and go to the other ranks; their answers leave.
#pragma once

#include <deque>
#include <set>
#include <string>
#include <vector>

#include "emulator/ranks/life_signs.hpp"
#include "host_tools/study/farm_messages.hpp"
#include "host_tools/study/hands.hpp"

namespace torolux::study {

/// A rank that falls silent or leaves does not answer: its orders come back as nobody's (Answer), and it is told on
/// standard error. One that is heard again gets orders again; what it still answers is for whom it was that ordered to
/// pass over.
class RankHands : public Hands {
 public:
  /// jobs: orders at once, of each rank. program: digest that theirs must have.
  RankHands(ranks::Transport& transport, unsigned jobs, std::string program, ranks::LifeTimes times = {});

  bool brings_results() const override { return true; }
  bool free() const override { return least_busy() != 0; }
  std::optional<pid_t> start(const Order& order) override;
  std::optional<Answer> poll() override;
  /// Nothing: `end` does.
  void stop() override {}
  /// Ends the others and what they still do, then closes the transport; the last call. exit_code: as of
  /// Transport::close.
  void end(int exit_code);

 private:
  struct Other {
    std::string host;                ///< empty: it has not greeted yet
    std::set<std::uint64_t> orders;  ///< not answered
    bool silent = false, left = false, ready = false;
  };

  unsigned least_busy() const;
  std::string name_of(unsigned rank) const;
  void receive(const ranks::Message& message);
  void greet(unsigned rank, const std::vector<std::byte>& bytes);
  void take_answer(unsigned rank, const std::vector<std::byte>& bytes);
  void give_up(const Other& other);
  void look_for_silence();
  void send_all(FarmMessage kind, const std::vector<std::byte>& bytes);

  ranks::Transport& transport_;
  unsigned jobs_;
  std::string program_;
  ranks::LifeTimes times_;
  std::vector<Other> others_;  ///< by rank; the first is not used
  std::deque<Answer> answers_;
  std::optional<ranks::LifeSigns> life_;
};

}  // namespace torolux::study
