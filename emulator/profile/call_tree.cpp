// SPDX-License-Identifier: MIT
// Children are a list, the one last used is looked at first: most calls come from loops.
#include "emulator/profile/call_tree.hpp"

namespace torolux::profile {

/// Where a new node would be one too many: the parent that has room for it.
NodeNumber CallTree::place_for(NodeNumber parent) {
  if (nodes_.size() < kMostPaths && nodes_[parent].depth < kLongestPath) return parent;
  cut_ = true;
  return nodes_[parent].depth < kLongestPath ? kRoot : nodes_[parent].parent;
}

NodeNumber CallTree::child_of(NodeNumber parent, FunctionNumber function) {
  for (;;) {
    if (const NodeNumber last = nodes_[parent].last_used_child; last != kRoot && nodes_[last].function == function)
      return last;
    for (NodeNumber child = nodes_[parent].first_child; child != kRoot; child = nodes_[child].next_sibling) {
      if (nodes_[child].function == function) return nodes_[parent].last_used_child = child;
    }
    const NodeNumber place = parent == kRoot ? kRoot : place_for(parent);
    if (place == parent) break;
    parent = place;
  }
  const auto made = static_cast<NodeNumber>(nodes_.size());
  CallNode node;
  node.parent = parent;
  node.function = function;
  node.depth = nodes_[parent].depth + 1;
  node.next_sibling = nodes_[parent].first_child;
  nodes_.push_back(node);
  nodes_[parent].first_child = nodes_[parent].last_used_child = made;
  return made;
}

}  // namespace torolux::profile
