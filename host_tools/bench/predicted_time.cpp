// SPDX-License-Identifier: MIT
// Plays the turns of a log once more, on threads that take them as the translated engine's do.
#include "host_tools/bench/predicted_time.hpp"

#include <algorithm>
#include <cstddef>
#include <deque>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <vector>

namespace torolux {
namespace {

constexpr double kNotBegun = std::numeric_limits<double>::infinity();

/// Turns in the order in which they could run.
class ByReady {
 public:
  explicit ByReady(const std::vector<Turn>& turns) : turns_(turns), order_(turns.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::ranges::stable_sort(order_, {}, [this](std::size_t turn) { return turns_[turn].ready; });
  }
  /// Calls `each` with those not yet taken that could run before this one is asked for, and with itself.
  template <class Each>
  void take_until(std::size_t turn, Each each) {
    for (; next_ < order_.size(); ++next_) {
      if (turns_[order_[next_]].ready >= turns_[turn].asked && order_[next_] > turn) return;
      each(order_[next_]);
    }
  }

 private:
  const std::vector<Turn>& turns_;
  std::vector<std::size_t> order_;
  std::size_t next_ = 0;
};

class Threads {
 public:
  Threads(const TurnLog& log, unsigned cores)
      : turns_(log.turns), end_(turns_.size(), kNotBegun), by_ready_(log.turns) {
    for (unsigned i = 1; i < cores; ++i) free_.push(0);
  }

  /// Until the scheduler has turn number `turn`, for which it asks.
  void ask(std::size_t turn) {
    by_ready_.take_until(turn, [this](std::size_t ready) { waiting_.push_back({ready, turns_[ready].ready + late_}); });
    double now = turns_[turn].asked + late_;
    take_until(now, 1);
    while (end_[turn] > now) {
      if (end_[turn] == kNotBegun) {
        now = run_here(turn, now);
      } else if (const std::size_t other = next_waiting(); other != turns_.size()) {
        now = run_here(other, now);
      } else {
        now = end_[turn];
      }
    }
    late_ = now - turns_[turn].asked;
  }
  /// By how much the scheduler is later than its own time.
  double late() const { return late_; }

 private:
  struct Waiting {
    std::size_t turn;
    double since;
  };

  /// The threads take what waits, but for the last `kept`, which they leave to the scheduler.
  void take_until(double now, std::size_t kept) {
    while (!free_.empty() && free_.top() <= now && next_waiting() != turns_.size() && waiting_.size() > kept) {
      const Waiting first = waiting_.front();
      const double begin = std::max(free_.top(), first.since);
      free_.pop();
      waiting_.pop_front();
      end_[first.turn] = begin + turns_[first.turn].seconds;
      free_.push(end_[first.turn]);
    }
  }
  /// The turn that has waited for longest, or their number where none does.
  std::size_t next_waiting() {
    while (!waiting_.empty() && end_[waiting_.front().turn] != kNotBegun) waiting_.pop_front();
    return waiting_.empty() ? turns_.size() : waiting_.front().turn;
  }
  /// On the scheduler's thread; returns when that is done.
  double run_here(std::size_t turn, double now) {
    end_[turn] = now + turns_[turn].seconds;
    take_until(end_[turn], 0);
    return end_[turn];
  }

  const std::vector<Turn>& turns_;
  std::vector<double> end_;  // by turn [s], or kNotBegun
  ByReady by_ready_;
  std::deque<Waiting> waiting_;
  std::priority_queue<double, std::vector<double>, std::greater<>> free_;  // when each thread but the scheduler's is
  double late_ = 0;
};

}  // namespace

double predicted_seconds(const TurnLog& log, unsigned cores) {
  Threads threads(log, cores);
  for (std::size_t turn = 0; turn < log.turns.size(); ++turn) threads.ask(turn);
  return log.own_seconds + threads.late();
}

double predicted_on_ranks(const TurnLog& log, unsigned ranks, double exchange) {
  std::uint32_t pes = 1;
  for (const Turn& turn : log.turns) pes = std::max(pes, turn.pe + 1);
  std::vector<double> free(ranks - 1, 0);
  std::vector<double> known(log.turns.size(), 0);  // when rank 0 knows that a turn is over [s]
  ByReady by_ready(log.turns);
  double late = 0;
  for (std::size_t turn = 0; turn < log.turns.size(); ++turn) {
    by_ready.take_until(turn, [&](std::size_t ready) {
      const Turn& begins = log.turns[ready];
      double& of_rank = free[std::size_t{begins.pe} * free.size() / pes];
      of_rank = std::max(of_rank, begins.ready + late + exchange) + begins.seconds;
      known[ready] = of_rank + exchange;
    });
    late = std::max(log.turns[turn].asked + late, known[turn]) - log.turns[turn].asked;
  }
  return log.own_seconds + late;
}

double measured_seconds(const TurnLog& log) {
  return std::accumulate(log.turns.begin(), log.turns.end(), log.own_seconds,
                         [](double sum, const Turn& turn) { return sum + turn.seconds; });
}

}  // namespace torolux
