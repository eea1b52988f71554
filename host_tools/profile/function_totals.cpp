// SPDX-License-Identifier: MIT
// Functions are summed over the paths that they are on.
#include "host_tools/profile/function_totals.hpp"

#include <algorithm>

namespace torolux {
namespace {

using profile::CallNode;
using profile::PeProfile;

/// Own cycles of one PE, by name.
std::vector<std::uint64_t> own_cycles(const PeProfile& pe, const ProfileNames& names) {
  std::vector<std::uint64_t> own(names.all().size());
  for (const CallNode& node : pe.tree().nodes()) {
    own[names.of(pe, node.function)] += node.self;
    for (std::size_t reason = 0; reason < kWaitReasons; ++reason) own[reason] += node.waits[reason];
  }
  return own;
}

void add_spread(std::vector<FunctionTotals>& functions, const std::vector<std::uint64_t>& own, unsigned pe, bool first,
                std::size_t pes) {
  for (std::size_t name = 0; name < functions.size(); ++name) {
    Spread& spread = functions[name].spread;
    if (first || own[name] < spread.least) spread.least = own[name], spread.least_pe = pe;
    if (first || own[name] > spread.most) spread.most = own[name], spread.most_pe = pe;
    spread.mean += static_cast<double>(own[name]) / static_cast<double>(pes);
  }
}

}  // namespace

ProfileTotals totals_of(const profile::CycleProfile& profile, const ProfileNames& names, std::span<const unsigned> pes,
                        const PathTree& tree) {
  ProfileTotals totals;
  totals.functions.resize(names.all().size());
  for (NameNumber name = 0; name < totals.functions.size(); ++name) totals.functions[name].name = name;
  std::vector<bool> seen(totals.functions.size());
  for (std::size_t i = 1; i < tree.paths.size(); ++i) {
    const Path& path = tree.paths[i];
    FunctionTotals& function = totals.functions[path.name];
    seen[path.name] = true;
    function.calls += path.calls;
    function.self += path.self;
    if (is_wait(path.name)) {
      totals.waits += path.self;
      totals.functions[tree.paths[path.parent].name].waits += path.self;
    }
    bool inside_itself = false;
    for (std::size_t above = path.parent; above != 0 && !inside_itself; above = tree.paths[above].parent)
      inside_itself = tree.paths[above].name == path.name;
    if (!inside_itself) function.total += path.total;
  }
  totals.cycles = tree.cycles();
  for (const unsigned pe : pes)
    add_spread(totals.functions, own_cycles(profile.pe(pe), names), pe, pe == pes.front(), pes.size());
  std::erase_if(totals.functions, [&](const FunctionTotals& function) { return !seen[function.name]; });
  std::stable_sort(totals.functions.begin(), totals.functions.end(),
                   [](const FunctionTotals& a, const FunctionTotals& b) { return a.self > b.self; });
  return totals;
}

}  // namespace torolux
