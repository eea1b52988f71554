// SPDX-License-Identifier: MIT
// What stands on every PE: the hottest first, bytes as the stores have them; and who owns the rest: work and patches
// even, by the heat that is left.
#include "host_tools/layout/copies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "host_tools/layout/stage_layout.hpp"
#include "host_tools/setup/sample_heat.hpp"
#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux::test {
namespace {

using protocol::Stage;

constexpr MemoryMap kMap{0x8001'0000, 64, 0, 0};

class Copies : public testing::Test {
 protected:
  Placement placed(TorusSize torus, Stage stage, std::vector<bool> common, const Heat* heat = nullptr,
                   const std::string& allocation = "balanced") const {
    return make_placement(mesh_, cells_, {torus, std::nullopt, allocation, Scheme::spread},
                          {stage, heat, std::move(common), no_surfaces(stage)});
  }
  std::vector<bool> no_surfaces(Stage stage) const {
    return std::vector<bool>(stage == Stage::ray_tracing ? mesh_.parts.size() : 0);
  }
  CopyOrder order(Stage stage) const { return copy_order(mesh_, lists_, stage, heat_of_cells(heat_)); }

  /// Of the first cells that take no more than these bytes.
  double heat_in_turn(const std::vector<double>& heat, std::uint64_t most) const {
    std::set<std::uint32_t> polygons;
    std::uint64_t bytes = 0;
    double sum = 0;
    for (CellIndex cell = 0; cell < grid_.count(); ++cell) {
      if (lists_[cell].empty()) continue;
      bytes += cell_bytes(lists_[cell].size());
      for (const std::uint32_t t : lists_[cell])
        bytes += polygons.insert(t).second ? polygon_bytes(mesh_.triangles[t], Stage::radiosity) : 0;
      if (bytes > most) break;
      sum += heat[cell];
    }
    return sum;
  }

  const Scene scene_ = room_with_box();
  const Mesh mesh_ = make_mesh(scene_, {.patch_length = 0.2, .element_length = 0.1});
  const Grid grid_ = make_grid(mesh_.space, std::array<std::uint32_t, 3>{6, 5, 7}, 0, 0);
  const CellLists cells_ = list_cells(mesh_, grid_);
  const std::vector<std::vector<std::uint32_t>>& lists_ = cells_.polygons;
  const Heat heat_ = sample_radiosity_heat(
      scene_, mesh_, make_placement(mesh_, cells_, {{1, 1}, std::nullopt, "modulo", Scheme::spread}, {}), 32);
};

std::uint64_t bytes_of(const PeLayout& layout, const std::set<std::string>& stores) {
  std::uint64_t sum = 0;
  for (const StoreBytes& store : layout.bytes) sum += stores.count(store.name) > 0 ? store.bytes : 0;
  return sum;
}

// Held to the stores' layout: nothing that a copy brings is forgotten.
TEST_F(Copies, BytesAreThoseOfTheStores) {
  const std::set<std::string> stores{"subspaces", "polygon list",     "polygons",   "normals",
                                     "nodes",     "patch references", "irradiance", "texture points"};
  for (const Stage stage : {Stage::radiosity, Stage::ray_tracing}) {
    const CopyOrder all = order(stage);
    ASSERT_EQ(all.cells.size(), all.bytes.size());
    for (const std::size_t count : {std::size_t{1}, std::size_t{9}, all.cells.size()}) {
      const Placement placement = placed({1, 2}, stage, all.first(count, grid_.count()), nullptr, "block");
      const Placement more = placement.with_nobody();
      EXPECT_EQ(all.bytes[count - 1], bytes_of(lay_out(mesh_, more, 2, stage, stage_parameters(), kMap), stores))
          << count;
    }
  }
}

TEST_F(Copies, AreTakenByHeatPerByteAndWithinABudget) {
  const CopyOrder all = order(Stage::radiosity);
  const auto filled = std::count_if(lists_.begin(), lists_.end(), [](const auto& list) { return !list.empty(); });
  EXPECT_EQ(all.cells.size(), static_cast<std::size_t>(filled)) << "all but the empty ones, each once";
  EXPECT_EQ(std::set<CellIndex>(all.cells.begin(), all.cells.end()).size(), all.cells.size());
  EXPECT_TRUE(std::is_sorted(all.bytes.begin(), all.bytes.end()));
  for (const double least : {0.0, all.worth[4], all.worth[4] * 1.0001, 1e30}) {
    const std::size_t count = all.worth_at_least(least);
    EXPECT_TRUE(count == 0 || all.worth[count - 1] >= least);
    EXPECT_TRUE(count == all.cells.size() || all.worth[count] < least);
  }
  // In half of the bytes that all need there is more heat than in what cells in the order of their numbers put there.
  const std::vector<double> heat = heat_of_cells(heat_);
  const std::uint64_t half = all.bytes.back() / 2;
  double hottest = 0;
  for (std::size_t i = 0; all.bytes[i] <= half; ++i) hottest += heat[all.cells[i]];
  EXPECT_GT(hottest, 1.2 * heat_in_turn(heat, half));
  EXPECT_EQ(order(Stage::radiosity).cells, all.cells) << "the same every time";
}

TEST_F(Copies, CellsWithMoreThanAShareAreBeforeAllOthers) {
  const std::vector<double> heat = heat_of_cells(heat_);
  std::vector<double> sorted = heat;
  std::sort(sorted.rbegin(), sorted.rend());
  const double share = sorted[10];
  const CopyOrder by_share = copy_order(mesh_, lists_, Stage::radiosity, heat, {}, share);
  for (std::size_t i = 0; i < by_share.cells.size(); ++i) EXPECT_EQ(heat[by_share.cells[i]] > share, i < 10) << i;
  EXPECT_TRUE(std::is_sorted(by_share.worth.rbegin(), by_share.worth.rend()));
  EXPECT_NE(order(Stage::radiosity).cells, by_share.cells);
}

TEST_F(Copies, OneHotCellAmongEqualsIsFirst) {
  std::vector<double> heat(grid_.count(), 1);
  const CopyOrder cold = copy_order(mesh_, lists_, Stage::radiosity, heat);
  const CellIndex last = cold.cells.back();
  heat[last] = 1e6;
  EXPECT_EQ(copy_order(mesh_, lists_, Stage::radiosity, heat).cells.front(), last);
}

// A polygon that all PEs have anyway costs nothing, so cells that need only such come first.
TEST_F(Copies, WhatAllHaveAnywayIsFree) {
  const std::vector<double> heat(grid_.count(), 1);
  const CellIndex last = copy_order(mesh_, lists_, Stage::radiosity, heat).cells.back();
  std::vector<double> lacking(mesh_.triangles.size(), 1);
  for (const std::uint32_t t : lists_[last]) lacking[t] = 0;
  const CopyOrder order = copy_order(mesh_, lists_, Stage::radiosity, heat, lacking);
  std::set<std::uint32_t> free(lists_[last].begin(), lists_[last].end());
  EXPECT_TRUE(std::all_of(lists_[order.cells[0]].begin(), lists_[order.cells[0]].end(),
                          [&](std::uint32_t t) { return free.count(t) > 0; }));
  std::uint64_t bytes = cell_bytes(lists_[order.cells[0]].size());
  for (const std::uint32_t t : lists_[order.cells[0]]) bytes += polygon_bytes(mesh_.triangles[t], Stage::radiosity);
  EXPECT_GE(order.bytes[0], bytes) << "but its bytes are told in full";
}

TEST_F(Copies, CommonPartsOfAllPesAreTheSame) {
  const CopyOrder all = order(Stage::radiosity);
  const Placement placement = placed({3, 2}, Stage::radiosity, all.first(20, grid_.count()), &heat_);
  EXPECT_EQ(placement.common_cells, 20U);
  std::vector<std::uint32_t> holders(grid_.count());
  for (unsigned pe = 0; pe < 6; ++pe) {
    const auto& polygons = placement.polygons_of_pe[pe];
    const auto& cells = placement.cells_of_pe[pe];
    EXPECT_TRUE(std::equal(polygons.begin(), polygons.begin() + placement.common_polygons,
                           placement.polygons_of_pe[0].begin()));
    EXPECT_TRUE(std::equal(cells.begin(), cells.begin() + 20, placement.cells_of_pe[0].begin()));
    EXPECT_TRUE(std::is_sorted(polygons.begin(), polygons.begin() + placement.common_polygons));
    EXPECT_TRUE(std::is_sorted(polygons.begin() + placement.common_polygons, polygons.end()));
    EXPECT_EQ(std::set<std::uint32_t>(polygons.begin(), polygons.end()).size(), polygons.size()) << "each once";
    for (std::size_t local = 0; local < cells.size(); ++local) {
      ++holders[cells[local]];
      EXPECT_EQ(placement.local_of_cell[cells[local]], local);
      for (const std::uint32_t t : lists_[cells[local]]) {
        const auto number = placement.local_polygon(static_cast<protocol::PeNumber>(pe), t);
        ASSERT_TRUE(number.has_value());
        EXPECT_EQ(polygons[*number], t);
      }
    }
  }
  for (CellIndex cell = 0; cell < grid_.count(); ++cell) {
    EXPECT_EQ(holders[cell], lists_[cell].empty() ? 0U : placement.common_cell[cell] ? 6U : 1U);
  }
}

TEST_F(Copies, RemainingHeatIsAllOfIt) {
  const RemainingHeat none = remaining_heat(heat_, {});
  const RemainingHeat all = remaining_heat(heat_, std::vector<bool>(grid_.count(), true));
  EXPECT_EQ(none.anywhere, 0);
  EXPECT_EQ(std::accumulate(all.of_cell.begin(), all.of_cell.end(), 0.0), 0);
  const std::vector<bool> some = order(Stage::radiosity).first(20, grid_.count());
  const RemainingHeat rest = remaining_heat(heat_, some);
  double owned = 0;
  double hand_overs = 0;
  for (const double cycles : rest.of_cell) owned += cycles;
  for (CellIndex cell = 0; cell < grid_.count(); ++cell) {
    if (some[cell]) {
      EXPECT_EQ(rest.of_cell[cell], 0);
    }
  }
  for (const double cycles : none.of_cell) hand_overs += cycles;
  hand_overs -= all.anywhere;  // all visits' own cycles
  EXPECT_GT(hand_overs, 0);
  EXPECT_LT(owned + rest.anywhere, all.anywhere + hand_overs) << "fewer hand-overs";
  EXPECT_GT(owned + rest.anywhere, all.anywhere);
}

// Two heavy cells and the rest: nobody is left with more than the mean, but for what one cell makes.
TEST_F(Copies, BalancedLeavesAllEqualWork) {
  for (const std::size_t count : {std::size_t{0}, std::size_t{30}, order(Stage::radiosity).cells.size()}) {
    const std::vector<bool> common = order(Stage::radiosity).first(count, grid_.count());
    const Placement placement = placed({3, 2}, Stage::radiosity, common, &heat_);
    const RemainingHeat rest = remaining_heat(heat_, common);
    std::vector<double> load(6);
    double greatest = 0;
    for (CellIndex cell = 0; cell < grid_.count(); ++cell) {
      load[placement.pe_of_cell[cell]] += rest.of_cell[cell];
      greatest = std::max(greatest, rest.of_cell[cell]);
    }
    std::uint32_t patches = 0;
    for (std::size_t p = 0; p < mesh_.patches.size(); ++p) load[placement.patch_home[p].pe] += heat_.deposits[p];
    for (const auto& own : placement.patches_of_pe) {
      patches += static_cast<std::uint32_t>(own.size());
      EXPECT_LT(own.size() * 6, mesh_.patches.size() * 2) << "twice its part of the patches at most";
    }
    EXPECT_EQ(patches, mesh_.patches.size());
    const double mean = std::accumulate(load.begin(), load.end(), 0.0) / 6;
    // Patches are shared out as if half of what they receive were even.
    const double deposits = std::accumulate(heat_.deposits.begin(), heat_.deposits.end(), 0.0);
    for (const double pe : load) EXPECT_LT(pe, mean + greatest + 0.5 * deposits / 6) << count;
    EXPECT_EQ(placement.idle_pes(), 0U);
  }
}

TEST_F(Copies, APeWithNothingIsCounted) {
  SceneBuilder builder;
  const std::uint32_t lamp = builder.material({0, 0, 0}, {1, 1, 1});
  builder.quad(lamp, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  const Mesh mesh = make_mesh(builder.scene, {.patch_length = 5, .element_length = 5});
  EXPECT_EQ(mesh.patches.size(), 2U);
  const Placement placement = make_placement(mesh, {{4, 1}, std::array<std::uint32_t, 3>{1, 1, 1}, "skewed"});
  EXPECT_EQ(placement.idle_pes(), 3U);
}

}  // namespace
}  // namespace torolux::test
