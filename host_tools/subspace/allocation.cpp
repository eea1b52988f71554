// SPDX-License-Identifier: MIT
// See allocation.hpp.
#include "host_tools/subspace/allocation.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <optional>
#include <string>

#include "emulator/errors.hpp"
#include "emulator/torus/shape.hpp"

namespace torolux {
namespace {

using protocol::PeNumber;
using Cell = std::array<std::uint32_t, 3>;

std::optional<std::array<std::size_t, 3>> skew_axes(std::string_view name) {
  constexpr std::string_view prefix = "skewed:";
  if (name == "skewed") return std::array<std::size_t, 3>{0, 2, 1};
  if (!name.starts_with(prefix) || name.size() != prefix.size() + 2) return std::nullopt;
  const auto axis = [](char letter) { return static_cast<std::size_t>(letter - 'x'); };
  const std::size_t a = axis(name[prefix.size()]);
  const std::size_t b = axis(name[prefix.size() + 1]);
  if (a > 2 || b > 2 || a == b) return std::nullopt;
  return std::array<std::size_t, 3>{a, b, 3 - a - b};
}

/// Column and row of a cell, where a formula gives them.
std::function<std::array<std::uint32_t, 2>(const Cell&)> formula(std::string_view name, const Grid& grid,
                                                                 const TorusSize& torus) {
  const std::uint32_t p = torus.columns;
  const std::uint32_t q = torus.rows;
  if (const auto axes = skew_axes(name)) {
    return [p, q, a = *axes](const Cell& c) { return std::array{(c[a[0]] + c[a[1]]) % p, c[a[2]] % q}; };
  }
  if (name == "skewed-both") {
    return [p, q](const Cell& c) { return std::array{(c[0] + c[2]) % p, (c[1] + c[2]) % q}; };
  }
  if (name == "modulo") {
    return [p, q](const Cell& c) { return std::array{c[0] % p, c[1] % q}; };
  }
  if (name == "block") {
    return [p, q, cells = grid.cells](const Cell& c) { return std::array{c[0] * p / cells[0], c[1] * q / cells[1]}; };
  }
  return {};
}

std::vector<PeNumber> balanced(const Grid& grid, const TorusSize& torus, std::span<const CellCost> costs) {
  CellCost total;
  for (const CellCost& cost : costs) {
    total.bytes += cost.bytes;
    total.cycles += cost.cycles;
  }
  // Shares of the whole, so that neither outweighs the other.
  const auto part = [](std::uint64_t value, std::uint64_t whole) {
    return whole == 0 ? 0.0 : static_cast<double>(value) / static_cast<double>(whole);
  };
  std::vector<CellIndex> order(grid.count());
  std::iota(order.begin(), order.end(), 0U);
  const auto weight = [&](CellIndex cell) {
    return std::max(part(costs[cell].bytes, total.bytes), part(costs[cell].cycles, total.cycles));
  };
  std::stable_sort(order.begin(), order.end(), [&](CellIndex a, CellIndex b) { return weight(a) > weight(b); });
  std::vector<CellCost> sum(torus.pes());
  std::vector<PeNumber> pe_of_cell(grid.count());
  for (const CellIndex cell : order) {
    unsigned best = 0;
    double best_fill = 0;
    for (unsigned pe = 0; pe < torus.pes(); ++pe) {
      const double fill = std::max(part(sum[pe].bytes + costs[cell].bytes, total.bytes),
                                   part(sum[pe].cycles + costs[cell].cycles, total.cycles));
      if (pe == 0 || fill < best_fill) {
        best = pe;
        best_fill = fill;
      }
    }
    sum[best].bytes += costs[cell].bytes;
    sum[best].cycles += costs[cell].cycles;
    pe_of_cell[cell] = static_cast<PeNumber>(best);
  }
  return pe_of_cell;
}

}  // namespace

unsigned TorusSize::hops(PeNumber a, PeNumber b) const {
  return TorusShape(columns, rows).hops(a, b);
}

bool is_allocation(std::string_view name) {
  return name == "balanced" || static_cast<bool>(formula(name, Grid{}, TorusSize{}));
}

std::vector<PeNumber> allocate(std::string_view name, const Grid& grid, const TorusSize& torus,
                               std::span<const CellCost> costs) {
  if (name == "balanced") return balanced(grid, torus, costs);
  const auto place = formula(name, grid, torus);
  if (!place) {
    throw UsageError("--allocation: '" + std::string(name) +
                     "' is none of skewed, skewed:AB (two of x, y, z), skewed-both, modulo, block, balanced");
  }
  std::vector<PeNumber> pe_of_cell(grid.count());
  for (CellIndex cell = 0; cell < grid.count(); ++cell) {
    const auto [column, row] = place(grid.cell(cell));
    pe_of_cell[cell] = static_cast<PeNumber>(row * torus.columns + column);
  }
  return pe_of_cell;
}

double mean_neighbour_hops(const Grid& grid, const TorusSize& torus, std::span<const PeNumber> pe_of_cell) {
  std::uint64_t pairs = 0;
  std::uint64_t hops = 0;
  for (CellIndex index = 0; index < grid.count(); ++index) {
    const Cell cell = grid.cell(index);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (cell[axis] + 1 == grid.cells[axis]) continue;
      Cell next = cell;
      ++next[axis];
      hops += torus.hops(pe_of_cell[index], pe_of_cell[grid.index(next)]);
      ++pairs;
    }
  }
  return pairs == 0 ? 0.0 : static_cast<double>(hops) / static_cast<double>(pairs);
}

}  // namespace torolux
