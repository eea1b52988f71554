// SPDX-License-Identifier: MIT
// Allocation: every subspace on one PE of the torus, neighbours near each other, load spread.
#include "host_tools/subspace/allocation.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "emulator/errors.hpp"

namespace torolux {
namespace {

const char* const kNames[] = {"skewed", "skewed:xy", "skewed:zy", "skewed-both", "modulo", "block", "balanced"};

Grid grid_of(std::array<std::uint32_t, 3> cells) {
  return make_grid(SceneSpace{}, cells, 12, 1);
}

std::vector<CellCost> costs_of(const Grid& grid) {
  std::vector<CellCost> costs;
  for (CellIndex cell = 0; cell < grid.count(); ++cell)
    costs.push_back({100 + cell % 7 * 50, 1000.0 + cell % 11 * 400});
  return costs;
}

TEST(Allocation, EverySubspaceIsOnAPeOfTheTorus) {
  const Grid grid = grid_of({8, 6, 9});
  for (const char* name : kNames) {
    EXPECT_TRUE(is_allocation(name));
    for (const TorusSize& torus : {TorusSize{1, 1}, TorusSize{4, 4}, TorusSize{3, 5}, TorusSize{1, 8}}) {
      const auto pes = allocate(name, grid, torus, costs_of(grid));
      ASSERT_EQ(pes.size(), grid.count());
      EXPECT_LT(*std::max_element(pes.begin(), pes.end()), torus.pes()) << name;
    }
  }
}

TEST(Allocation, EveryPeIsUsedWhereTheGridIsLargeEnough) {
  const Grid grid = grid_of({8, 8, 8});
  for (const char* name : kNames) {
    const auto pes = allocate(name, grid, {4, 4}, costs_of(grid));
    for (unsigned pe = 0; pe < 16; ++pe) EXPECT_NE(std::count(pes.begin(), pes.end(), pe), 0) << name << " PE " << pe;
  }
}

TEST(Allocation, SkewedPutsNeighboursOnTheSameOrAdjacentPes) {
  const Grid grid = grid_of({7, 9, 8});
  const TorusSize torus{4, 5};
  for (const char* name : {"skewed", "skewed:xy", "skewed:yz"}) {
    const auto pes = allocate(name, grid, torus, {});
    for (CellIndex index = 0; index < grid.count(); ++index) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        auto next = grid.cell(index);
        if (++next[axis] == grid.cells[axis]) continue;
        EXPECT_LE(torus.hops(pes[index], pes[grid.index(next)]), 1U) << name;
      }
    }
  }
}

TEST(Allocation, FormulasAreAsDocumented) {
  const Grid grid = grid_of({8, 8, 8});
  const CellIndex cell = grid.index({3, 6, 2});
  const TorusSize torus{4, 4};
  EXPECT_EQ(allocate("skewed", grid, torus, {})[cell], 4 * (6 % 4) + (3 + 2) % 4);
  EXPECT_EQ(allocate("skewed:xy", grid, torus, {})[cell], 4 * (2 % 4) + (3 + 6) % 4);
  EXPECT_EQ(allocate("skewed-both", grid, torus, {})[cell], 4 * ((6 + 2) % 4) + (3 + 2) % 4);
  EXPECT_EQ(allocate("modulo", grid, torus, {})[cell], 4 * (6 % 4) + 3);
  EXPECT_EQ(allocate("block", grid, torus, {})[cell], 4 * 3 + 1);
}

TEST(Allocation, BalancedSpreadsLoadAndMemory) {
  const Grid grid = grid_of({8, 8, 8});
  std::vector<CellCost> costs = costs_of(grid);
  costs[77].cycles *= 20;  // a hot subspace
  const auto pes = allocate("balanced", grid, {4, 4}, costs);
  std::vector<CellCost> sum(16);
  CellCost total;
  for (CellIndex cell = 0; cell < grid.count(); ++cell) {
    sum[pes[cell]].bytes += costs[cell].bytes;
    sum[pes[cell]].cycles += costs[cell].cycles;
    total.bytes += costs[cell].bytes;
    total.cycles += costs[cell].cycles;
  }
  for (const CellCost& pe : sum) {
    EXPECT_LT(pe.cycles * 16, total.cycles * 11 / 10);  // within 10 % of the mean: 32 subspaces on each PE
    EXPECT_LT(pe.bytes * 16, total.bytes * 5 / 4);      // kMostMemory
  }
  EXPECT_EQ(pes, allocate("balanced", grid, {4, 4}, costs));
}

TEST(Allocation, UnknownNamesAreRefusedWithTheKnownOnes) {
  for (const char* name : {"", "skewd", "skewed:", "skewed:xx", "skewed:xw", "skewed:xyz", "Modulo"}) {
    EXPECT_FALSE(is_allocation(name));
    EXPECT_THROW(allocate(name, grid_of({2, 2, 2}), {1, 1}, {}), UsageError) << name;
  }
}

TEST(Torus, HopsGoTheShorterWay) {
  const TorusSize torus{5, 4};
  EXPECT_EQ(torus.hops(0, 4), 1U);
  EXPECT_EQ(torus.hops(0, 2), 2U);
  EXPECT_EQ(torus.hops(0, 15), 1U);
  EXPECT_EQ(torus.hops(1, 13), 4U);
}

TEST(Torus, MeanNeighbourHops) {
  const Grid grid = grid_of({4, 1, 1});
  EXPECT_DOUBLE_EQ(mean_neighbour_hops(grid, {4, 1}, allocate("modulo", grid, {4, 1}, {})), 1.0);
  EXPECT_DOUBLE_EQ(mean_neighbour_hops(grid, {1, 1}, allocate("modulo", grid, {1, 1}, {})), 0.0);
}

}  // namespace
}  // namespace torolux
