// SPDX-License-Identifier: MIT
// Formulas in the cell's coordinates; or `balanced`, greedy: the costliest cell first, to a PE with room and about the
// least load, of these the one nearest to the cell's neighbours.
#include "host_tools/subspace/allocation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>

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

/// Of the mean load: what a PE may have to do more than the least loaded one and still be chosen for its place.
constexpr double kEquallyLoaded = 0.02;

class Balancer {
 public:
  Balancer(const Grid& grid, const TorusSize& torus, std::span<const CellCost> costs, double most_memory)
      : grid_(grid), torus_(torus), costs_(costs), bytes_(torus.pes()), load_(torus.pes()), pe_of_cell_(grid.count()) {
    double all_bytes = 0;
    double all_cycles = 0;
    for (const CellCost& cost : costs) {
      all_bytes += static_cast<double>(cost.bytes);
      all_cycles += cost.cycles;
    }
    by_bytes_ = !(all_cycles > 0);
    most_bytes_ = by_bytes_ ? all_bytes : most_memory * all_bytes / torus.pes();
    tolerance_ = kEquallyLoaded * (by_bytes_ ? all_bytes : all_cycles) / torus.pes();
  }

  std::vector<PeNumber> allocate() {
    std::vector<CellIndex> order;
    for (CellIndex cell = 0; cell < grid_.count(); ++cell) {
      pe_of_cell_[cell] = static_cast<PeNumber>(cell % torus_.pes());
      if (costs_[cell].bytes > 0 || costs_[cell].cycles > 0) order.push_back(cell);
    }
    std::stable_sort(order.begin(), order.end(), [&](CellIndex a, CellIndex b) {
      return cycles(a) != cycles(b) ? cycles(a) > cycles(b) : costs_[a].bytes > costs_[b].bytes;
    });
    placed_.resize(grid_.count());
    for (const CellIndex cell : order) place(cell);
    return std::move(pe_of_cell_);
  }

 private:
  double cycles(CellIndex cell) const {
    return by_bytes_ ? static_cast<double>(costs_[cell].bytes) : costs_[cell].cycles;
  }

  void place(CellIndex cell) {
    const auto bytes = static_cast<double>(costs_[cell].bytes);
    const double least_bytes = *std::min_element(bytes_.begin(), bytes_.end());
    const double most_before = std::max(most_bytes_ - bytes, least_bytes);
    double least = HUGE_VAL;
    for (std::size_t pe = 0; pe < load_.size(); ++pe) {
      if (bytes_[pe] <= most_before) least = std::min(least, load_[pe]);
    }
    const std::vector<PeNumber> near = placed_neighbours(cell);
    std::size_t best = 0;
    std::optional<std::pair<unsigned, double>> best_place;  // hops, load
    for (std::size_t pe = 0; pe < load_.size(); ++pe) {
      if (bytes_[pe] > most_before || load_[pe] > least + tolerance_) continue;
      unsigned hops = 0;
      for (const PeNumber neighbour : near) hops += torus_.hops(static_cast<PeNumber>(pe), neighbour);
      const std::pair place(hops, load_[pe]);
      if (best_place && !(place < *best_place)) continue;
      best = pe;
      best_place = place;
    }
    bytes_[best] += bytes;
    load_[best] += cycles(cell);
    pe_of_cell_[cell] = static_cast<PeNumber>(best);
    placed_[cell] = true;
  }

  /// PEs of the face-adjacent cells that have been placed.
  std::vector<PeNumber> placed_neighbours(CellIndex index) const {
    std::vector<PeNumber> pes;
    const Cell cell = grid_.cell(index);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const bool upper : {false, true}) {
        if (upper ? cell[axis] + 1 == grid_.cells[axis] : cell[axis] == 0) continue;
        Cell next = cell;
        next[axis] = upper ? cell[axis] + 1 : cell[axis] - 1;
        if (placed_[grid_.index(next)]) pes.push_back(pe_of_cell_[grid_.index(next)]);
      }
    }
    return pes;
  }

  const Grid& grid_;
  const TorusSize& torus_;
  std::span<const CellCost> costs_;
  bool by_bytes_ = false;
  double most_bytes_ = 0;
  double tolerance_ = 0;
  std::vector<double> bytes_, load_;  ///< by PE
  std::vector<PeNumber> pe_of_cell_;
  std::vector<bool> placed_;
};

}  // namespace

unsigned TorusSize::hops(PeNumber a, PeNumber b) const {
  return TorusShape(columns, rows).hops(a, b);
}

bool is_allocation(std::string_view name) {
  return name == "balanced" || static_cast<bool>(formula(name, Grid{}, TorusSize{}));
}

std::vector<PeNumber> allocate(std::string_view name, const Grid& grid, const TorusSize& torus,
                               std::span<const CellCost> costs, double most_memory) {
  if (name == "balanced") return Balancer(grid, torus, costs, most_memory).allocate();
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
