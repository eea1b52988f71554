// SPDX-License-Identifier: MIT
// Where PEs stand when a machine does not go on: what each waits for, and where. PEs in the same place share a line.
#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "emulator/machine/emulation.hpp"

namespace torolux {
namespace {

constexpr unsigned kMostReported = 16;
/// Of each place, so many PEs are named.
constexpr std::size_t kMostNamed = 16;
/// Of so many places the calls are told.
constexpr std::size_t kMostCallStacks = 4;
constexpr std::size_t kMostPlaces = 32;
/// It takes a moment for each.
constexpr unsigned kMostLookedAt = 4096;

/// What a PE does and what several do, before the place; by WaitKind.
using Doing = std::array<const char*, 2>;
constexpr std::array<Doing, 7> kDoings = {
    {{"runs in", "run in"},
     {"waits in", "wait in"},
     {"looks for an arrival in", "look for an arrival in"},
     {"waits for a place in its queue to the torus in", "wait for a place in their queues to the torus in"},
     {"waits for a place in its queue to the bus in", "wait for a place in their queues to the bus in"},
     {"has halted", "have halted"},
     {"has come to the end of the run in", "have come to the end of the run in"}}};

/// PEs that do the same in the same place.
struct Group {
  WaitKind doing;
  CallStacks::Place place;
  std::vector<unsigned> pes;
};

std::string in_words(const Group& group) {
  const bool several = group.pes.size() > 1;
  const std::string doing = kDoings[static_cast<std::size_t>(group.doing)][several ? 1 : 0];
  std::string text = "\n  " + std::to_string(group.pes.size()) + (several ? " PEs " : " PE ") + doing;
  if (group.doing != WaitKind::halted)
    text += " " + (group.place.words.empty() ? "a place that this engine cannot tell" : group.place.words);
  for (std::size_t i = 0; i < group.pes.size() && i < kMostNamed; ++i)
    text += (i == 0 ? " (" : ", ") + std::to_string(group.pes[i]);
  return text + (group.pes.size() > kMostNamed ? ", ...)" : ")");
}

}  // namespace

std::string Emulation::where_pes_stand() {
  std::vector<Group> groups;
  const unsigned looked_at = std::min(pes_, kMostLookedAt);
  for (unsigned pe = 0; pe < looked_at; ++pe) {
    nius_[pe].refresh(events_, pool_, times_);
    const WaitKind doing = nius_[pe].waits_for();
    CallStacks::Place place = doing == WaitKind::halted ? CallStacks::Place{} : stacks_.place_of(pe);
    const auto same = [&](const Group& group) { return group.doing == doing && group.place.words == place.words; };
    auto group = std::ranges::find_if(groups, same);
    if (group == groups.end()) group = groups.insert(groups.end(), {doing, std::move(place), {}});
    group->pes.push_back(pe);
  }
  std::ranges::stable_sort(groups, std::ranges::greater(), [](const Group& group) { return group.pes.size(); });
  std::string text;
  for (std::size_t i = 0; i < groups.size() && i < kMostPlaces; ++i)
    text += in_words(groups[i]) + (i < kMostCallStacks ? groups[i].place.calls : "");
  if (groups.size() > kMostPlaces) text += "\n  PEs in " + std::to_string(groups.size() - kMostPlaces) + " more places";
  if (looked_at < pes_) text += "\n  and " + std::to_string(pes_ - looked_at) + " more PEs, which nobody has looked at";
  return text;
}

std::string Emulation::report_of(unsigned pe) const {
  const NiuNetworkSide& niu = nius_[pe];
  constexpr std::array<const char*, 7> kWaits = {"runs",
                                                 "waits to receive",
                                                 "looks for an arrival",
                                                 "waits for a place in its outgoing queue to the torus",
                                                 "waits for a place in its outgoing queue to the bus",
                                                 "has halted",
                                                 "has come to the end of the run"};
  return "  PE " + std::to_string(pe) + " (clock " + std::to_string(niu.channel().clock.load()) + ") " +
         kWaits[static_cast<std::size_t>(niu.waits_for())] + "; queued: torus " + std::to_string(torus_.queued(pe)) +
         ", bus " + std::to_string(parts_[pe].outgoing.size()) + ", from the host " +
         std::to_string(host_.waiting(pe)) + "; record slots in use " + std::to_string(niu.slots_used()) +
         (parts_[pe].diverting != kNoBlock ? "; diverts" : "") + "\n";
}

std::string Emulation::deadlock_report() {
  std::string text = "deadlock at cycle " + std::to_string(now_) +
                     ": nothing can happen any more, and work is outstanding\n  host program: " +
                     (program_->finished() ? "finished" : std::string("waits for ") + program_->waiting_for()) + "; " +
                     std::to_string(host_.inbox()) + " messages not yet read, " +
                     std::to_string(host_.waiting_for_all()) +
                     " broadcasts and what waits for them\n  bus: " + (bus_.busy() ? "busy" : "idle") +
                     "; FBC: " + std::to_string(controller_.waiting()) +
                     " messages; torus: " + std::to_string(torus_.packets_inside()) + " packets\n";
  unsigned reported = 0;
  for (unsigned pe = 0; pe < pes_ && reported < kMostReported; ++pe) {
    const bool plain = nius_[pe].waits_for() == WaitKind::receive && torus_.queued(pe) == 0 &&
                       parts_[pe].outgoing.empty() && host_.waiting(pe) == 0;
    if (plain && pes_ > kMostReported) continue;
    text += report_of(pe);
    ++reported;
  }
  if (reported < pes_) text += "  (other PEs wait to receive, or are like these)\n";
  text += torus_.report(kMostReported);
  if (text.ends_with("\n")) text.pop_back();
  return text + where_pes_stand();
}

}  // namespace torolux
