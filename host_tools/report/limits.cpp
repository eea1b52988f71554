// SPDX-License-Identifier: MIT
// Busy cycles over the stage's length. The greatest share is the cause where that part is saturated; else the busiest
// PE, the rounds' ends or waiting is, whichever explains most.
#include "host_tools/report/limits.hpp"

#include <algorithm>

#include "host_tools/report/text.hpp"

namespace torolux {
namespace {

constexpr std::array<Limit, 5> kParts = {Limit::work, Limit::bus, Limit::frame_buffer, Limit::host, Limit::link};

double& share_of(Limits& limits, Limit limit) {
  return limits.shares[static_cast<std::size_t>(limit)];
}

/// From the last shot done to the next round's first, of the rounds that begin in [begin, end).
double tails(const std::vector<RoundFigures>& rounds, Cycles begin, Cycles end) {
  double sum = 0;
  for (const RoundFigures& round : rounds) {
    if (round.begin < begin || round.begin >= end) continue;
    sum += static_cast<double>(round.tail() + (round.chosen - round.begin));
  }
  return sum;
}

Cycles busiest_link(const MachineFigures& figures) {
  Cycles most = 0;
  for (const RouterFigures& router : figures.routers) {
    for (const LinkFigures& link : router.links) most = std::max(most, link.busy);
  }
  return most;
}

}  // namespace

Limits limits_of(const StageFigures& stage, const std::vector<RoundFigures>& rounds) {
  Limits limits;
  const MachineFigures& figures = stage.figures;
  if (figures.now == 0 || figures.pes.empty()) return limits;
  const auto length = static_cast<double>(figures.now);
  double mean = 0;
  double most = 0;
  for (const PeFigures& pe : figures.pes) {
    const double share = static_cast<double>(pe.busy_cycles) / length;
    mean += share / static_cast<double>(figures.pes.size());
    most = std::max(most, share);
  }
  most = std::min(most, 1.0);  // a PE enters a stage, and leaves it, a little later than the host
  mean = std::min(mean, most);
  share_of(limits, Limit::work) = mean;
  share_of(limits, Limit::balance) = most - mean;
  share_of(limits, Limit::waiting) = 1 - most;
  share_of(limits, Limit::tail) = tails(rounds, stage.begin, stage.begin + figures.now) / length;
  share_of(limits, Limit::bus) = static_cast<double>(figures.bus.busy_cycles()) / length;
  share_of(limits, Limit::frame_buffer) = static_cast<double>(figures.frame_buffer_busy_cycles) / length;
  share_of(limits, Limit::host) = static_cast<double>(figures.host.busy_cycles) / length;
  share_of(limits, Limit::link) = static_cast<double>(busiest_link(figures)) / length;

  const auto greater = [&](Limit a, Limit b) { return share_of(limits, a) < share_of(limits, b); };
  limits.by = *std::max_element(kParts.begin(), kParts.end(), greater);
  if (limits.share() >= kSaturated) return limits;
  limits.by = std::max(Limit::balance, Limit::waiting, greater);
  // Of the time in which even the busiest PE waits, most lies between the rounds' last shots and the next ones' first.
  if (limits.by == Limit::waiting && share_of(limits, Limit::tail) >= share_of(limits, Limit::waiting) / 2) {
    limits.by = Limit::tail;
  }
  return limits;
}

std::string limit_text(const Limits& limits) {
  const std::string busy = ", busy for " + percent(limits.share(), 0);
  switch (limits.by) {
    case Limit::work:
      return "the PEs' work";
    case Limit::balance:
      return "the busiest PE";
    case Limit::tail:
      return "rounds' ends, " + percent(limits.share(), 0);
    case Limit::waiting:
      return "waiting";
    case Limit::bus:
      return "bus" + busy;
    case Limit::frame_buffer:
      return "frame buffer" + busy;
    case Limit::host:
      return "host" + busy;
    case Limit::link:
      return "a link" + busy;
    case Limit::count:
      break;
  }
  return "";
}

}  // namespace torolux
