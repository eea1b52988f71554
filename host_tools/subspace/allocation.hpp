// SPDX-License-Identifier: MIT
// An allocation's name, the grid and the torus enter; which PE holds which subspace leaves.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "firmware/protocol/machine.hpp"
#include "host_tools/subspace/grid.hpp"

namespace torolux {

struct TorusSize {
  unsigned columns = 1;
  unsigned rows = 1;
  unsigned pes() const { return columns * rows; }
  /// Links between two PEs, the shorter way around in both dimensions.
  unsigned hops(protocol::PeNumber a, protocol::PeNumber b) const;
};

/// What a subspace is expected to cost its owner; for `balanced` only. Nothing at all: it does not matter who has it.
struct CellCost {
  std::uint64_t bytes = 0;
  double cycles = 0;
};

/// What `balanced` keeps to unless a machine's memory asks for less.
inline constexpr double kMostMemory = 1.25;

/// PE of each cell. Names, x y z counted from 0 on P columns and Q rows:
///   skewed       ((x + z) mod P, y mod Q): face-adjacent subspaces on the same or adjacent PEs
///   skewed:AB    the same with other axes: ((A + B) mod P, the third mod Q), A and B two of x, y, z
///   skewed-both  ((x + z) mod P, (y + z) mod Q)
///   modulo       (x mod P, y mod Q)
///   block        (x P / Gx, y Q / Gy): blocks of neighbours
///   balanced     the subspace that costs most cycles first, each to the PE that has least to do; among those that have
///                little more, to the one with the fewest hops to its neighbours. No PE gets more than `most_memory`
///                times the mean of bytes, while there is another. Without cycles: bytes in their place
/// Throws UsageError for another name.
std::vector<protocol::PeNumber> allocate(std::string_view name, const Grid& grid, const TorusSize& torus,
                                         std::span<const CellCost> costs, double most_memory = kMostMemory);

/// For checks on the command line and its help.
bool is_allocation(std::string_view name);

/// Mean of TorusSize::hops over all pairs of face-adjacent cells; 0 with one cell.
double mean_neighbour_hops(const Grid& grid, const TorusSize& torus, std::span<const protocol::PeNumber> pe_of_cell);

}  // namespace torolux
