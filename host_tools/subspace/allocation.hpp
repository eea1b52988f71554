// SPDX-License-Identifier: MIT
// Which PE holds which subspace.
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

/// What a subspace is expected to cost; for `balanced` only.
struct CellCost {
  std::uint64_t bytes = 0;
  std::uint64_t cycles = 0;
};

/// PE of each cell. Names, x y z counted from 0 on P columns and Q rows:
///   skewed       ((x + z) mod P, y mod Q): face-adjacent subspaces on the same or adjacent PEs
///   skewed:AB    the same with other axes: ((A + B) mod P, the third mod Q), A and B two of x, y, z
///   skewed-both  ((x + z) mod P, (y + z) mod Q)
///   modulo       (x mod P, y mod Q)
///   block        (x P / Gx, y Q / Gy): blocks of neighbours
///   balanced     dearest subspace first, each to the PE that is then the least full in memory and load
/// Throws UsageError for another name.
std::vector<protocol::PeNumber> allocate(std::string_view name, const Grid& grid, const TorusSize& torus,
                                         std::span<const CellCost> costs);

/// For checks on the command line and its help.
bool is_allocation(std::string_view name);

/// Mean of TorusSize::hops over all pairs of face-adjacent cells; 0 with one cell.
double mean_neighbour_hops(const Grid& grid, const TorusSize& torus, std::span<const protocol::PeNumber> pe_of_cell);

}  // namespace torolux
