// SPDX-License-Identifier: MIT
// Where cycles went: a tree of call paths. Enters: who called whom, cycles; leaves: cycles and calls of each path.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "emulator/niu/channel.hpp"
#include "emulator/profile/function_table.hpp"

namespace torolux::profile {

using NodeNumber = std::uint32_t;
inline constexpr NodeNumber kRoot = 0;
/// Most call paths of a PE. What comes later is charged to a path of the function alone.
inline constexpr std::size_t kMostPaths = 1U << 18U;
/// Longest path: of a deeper call, the functions between are left out.
inline constexpr std::uint32_t kLongestPath = 256;

/// A function as called on one path.
struct CallNode {
  NodeNumber parent = kRoot;
  FunctionNumber function = kUnnamed;                                             ///< of the root: none
  std::uint32_t depth = 0;                                                        ///< of the root: 0
  NodeNumber first_child = kRoot, last_used_child = kRoot, next_sibling = kRoot;  ///< kRoot: none
  std::uint64_t calls = 0;
  std::uint64_t self = 0;  ///< [cycles] executing its own instructions
  WaitCycles waits{};      ///< [cycles] waiting in HINTs that it executed itself, by WaitReason
};

class CallTree {
 public:
  /// The node of `function` called from `parent`; made where there is none.
  NodeNumber child_of(NodeNumber parent, FunctionNumber function);
  CallNode& at(NodeNumber node) { return nodes_[node]; }
  /// Every node stands behind its parent; the first is the root.
  const std::vector<CallNode>& nodes() const { return nodes_; }
  /// Some paths have been left out (kMostPaths, kLongestPath): functions' totals are too small.
  bool is_cut() const { return cut_; }

 private:
  NodeNumber place_for(NodeNumber parent);

  std::vector<CallNode> nodes_ = std::vector<CallNode>(1);
  bool cut_ = false;
};

}  // namespace torolux::profile
