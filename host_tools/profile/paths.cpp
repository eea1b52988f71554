// SPDX-License-Identifier: MIT
// Trees of PEs are put over one another, path by path; then the whole is put into order.
#include "host_tools/profile/paths.hpp"

#include <algorithm>
#include <utility>

namespace torolux {

using profile::CallNode;
using profile::PeProfile;

ProfileNames::ProfileNames(const profile::CycleProfile& profile) : names_(kWaitFrames.begin(), kWaitFrames.end()) {
  std::map<std::string, NameNumber> numbers;
  for (std::size_t pe = 0; pe < profile.pes(); ++pe) {
    const profile::FunctionTable& table = profile.pe(pe).functions();
    std::vector<NameNumber>& of_table = of_table_[&table];
    if (!of_table.empty()) continue;
    for (profile::FunctionNumber function = 0; function < table.size(); ++function) {
      const auto [at, is_new] = numbers.try_emplace(table.name(function), static_cast<NameNumber>(names_.size()));
      if (is_new) names_.push_back(table.name(function));
      of_table.push_back(at->second);
    }
  }
}

NameNumber ProfileNames::of(const PeProfile& pe, profile::FunctionNumber function) const {
  return of_table_.at(&pe.functions())[function];
}

namespace {

/// Paths in the order in which they have come.
class Merger {
 public:
  explicit Merger(const ProfileNames& names) : names_(names) {}

  void add(const PeProfile& pe) {
    const std::vector<CallNode>& nodes = pe.tree().nodes();
    std::vector<std::size_t> place_of(nodes.size());
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      const CallNode& node = nodes[i];
      place_of[i] = child_of(place_of[node.parent], names_.of(pe, node.function));
      paths_[place_of[i]].calls += node.calls;
      paths_[place_of[i]].self += node.self;
      for (NameNumber reason = 0; reason < kWaitReasons; ++reason) {
        if (node.waits[reason] != 0) paths_[child_of(place_of[i], reason)].self += node.waits[reason];
      }
    }
    cut_ |= pe.tree().is_cut();
  }

  PathTree finish() {
    for (std::size_t i = paths_.size(); i-- > 0;) {
      paths_[i].total += paths_[i].self;
      if (i != 0) paths_[paths_[i].parent].total += paths_[i].total;
    }
    std::vector<std::vector<std::size_t>> children(paths_.size());
    for (std::size_t i = 1; i < paths_.size(); ++i) children[paths_[i].parent].push_back(i);
    PathTree tree;
    tree.cut = cut_;
    std::vector<std::pair<std::size_t, std::size_t>> open = {{0, 0}};  // path, and its parent's place in the tree
    while (!open.empty()) {
      const auto [path, parent] = open.back();
      open.pop_back();
      const std::size_t place = tree.paths.size();
      tree.paths.push_back(paths_[path]);
      tree.paths.back().parent = parent;
      std::sort(children[path].begin(), children[path].end(),
                [this](std::size_t a, std::size_t b) { return key_of(a) < key_of(b); });
      for (const std::size_t child : children[path]) open.emplace_back(child, place);
    }
    return tree;
  }

 private:
  std::size_t child_of(std::size_t parent, NameNumber name) {
    const auto [at, is_new] = child_of_.try_emplace({parent, name}, paths_.size());
    if (is_new) paths_.push_back({parent, name, 0, 0, 0});
    return at->second;
  }
  /// The one that comes last is taken first.
  std::pair<std::uint64_t, NameNumber> key_of(std::size_t path) const {
    return {paths_[path].total, ~paths_[path].name};
  }

  const ProfileNames& names_;
  std::vector<Path> paths_ = {{0, 0, 0, 0, 0}};
  std::map<std::pair<std::size_t, NameNumber>, std::size_t> child_of_;
  bool cut_ = false;
};

}  // namespace

PathTree paths_of(const profile::CycleProfile& profile, const ProfileNames& names, std::span<const unsigned> pes) {
  Merger merger(names);
  for (const unsigned pe : pes) merger.add(profile.pe(pe));
  return merger.finish();
}

}  // namespace torolux
