// SPDX-License-Identifier: MIT
// Surfaces that one PE alone keeps: each once, evenly; every PE finds the same light or its keeper; and what all have
// is the same for all.
#include "host_tools/layout/keepers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/layout/copies.hpp"
#include "host_tools/layout/stage_image.hpp"
#include "host_tools/setup/sample_heat.hpp"
#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux::test {
namespace {

using protocol::PeNumber;
using protocol::Stage;

constexpr MemoryMap kMap{protocol::kLocalMemoryBase + 100'004, 64, 0, 0};
constexpr unsigned kPes = 6;

class Keepers : public testing::Test {
 protected:
  /// common: of the cells, every one but each `gap`th.
  Placement placed(unsigned gap) const {
    std::vector<bool> cells(lists_.grid.count());
    for (CellIndex cell = 0; cell < cells.size(); ++cell) cells[cell] = cell % gap != 0;
    std::vector<bool> surfaces(mesh_.parts.size());
    for (std::uint32_t part = 0; part < surfaces.size(); part += 5) surfaces[part] = true;
    return make_placement(mesh_, lists_, {{3, 2}, std::nullopt, "balanced", Scheme::spread},
                          {Stage::ray_tracing, nullptr, cells, surfaces});
  }
  PeLoad load(const Placement& placement, PeNumber pe, const PeLoad* common) const {
    const PeLayout layout = lay_out(mesh_, placement, pe, Stage::ray_tracing, stage_parameters(), kMap);
    return {layout.layout, ray_tracing_image(scene_, mesh_, placement, pe, units_, irradiance_, layout, {}, common)};
  }
  static std::vector<protocol::Flux> fluxes(std::uint32_t elements) {
    std::vector<protocol::Flux> flux(elements);
    for (std::uint32_t e = 0; e < elements; ++e) flux[e] = {1 + e * 1000003LL % 65537, 0, 0};
    return flux;
  }

  const Scene scene_ = room_with_box();
  const Mesh mesh_ = make_mesh(scene_, {.patch_length = 0.3, .element_length = 0.1});
  const LightUnits units_ = light_units(scene_, mesh_, false);
  const VertexIrradiance irradiance_ = make_vertex_irradiance(mesh_, fluxes(mesh_.elements), 1e-3, 1);
  const CellLists lists_ =
      list_cells(mesh_, make_grid(mesh_.space, std::array<std::uint32_t, 3>{4, 4, 4}, mesh_.triangles.size(), kPes));
};

template <typename T>
std::vector<T> store_of(const PeLoad& load, const protocol::Store& store) {
  std::vector<T> values(store.count);
  if (store.count == 0) return values;
  std::memcpy(values.data(), load.image.data() + store.address - load.layout.cell_words.address,
              values.size() * sizeof(T));
  return values;
}

TEST_F(Keepers, EachSurfaceHasOneAndAllHaveAlike) {
  const Placement placement = placed(1000);
  std::vector<std::uint64_t> bytes;
  std::vector<bool> seen(mesh_.parts.size());
  std::uint64_t most = 0;
  for (PeNumber pe = 0; pe < kPes; ++pe) {
    bytes.push_back(0);
    for (const std::uint32_t part : placement.kept_by_pe[pe]) {
      EXPECT_FALSE(seen[part]);
      seen[part] = true;
      EXPECT_EQ(placement.keeper_of_part[part], pe);
      bytes.back() += surface_size(mesh_, part).bytes();
      most = std::max(most, surface_size(mesh_, part).bytes());
    }
  }
  const auto [least, greatest] = std::minmax_element(bytes.begin(), bytes.end());
  EXPECT_LE(*greatest - *least, most) << "no better place for the last one";
  for (std::uint32_t part = 0; part < seen.size(); ++part) EXPECT_EQ(seen[part], part % 5 != 0) << part;
}

TEST_F(Keepers, EveryPeFindsTheLightOrItsKeeper) {
  for (const unsigned gap : {1000U, 3U}) {
    const Placement placement = placed(gap);
    const PeLoad common = load(placement.with_nobody(), kPes, nullptr);
    std::uint64_t elsewhere = 0;
    for (PeNumber pe = 0; pe < kPes; ++pe) {
      const PeLoad made = load(placement, pe, nullptr);
      EXPECT_EQ(load(placement, pe, &common).image, made.image) << "begun with what all have";
      const auto nodes = store_of<std::uint32_t>(made, made.layout.nodes);
      const auto kept = store_of<protocol::KeptSurface>(made, made.layout.kept);
      const auto light = store_of<protocol::CornerIrradiance>(made, made.layout.irradiance);
      const auto polygons = store_of<protocol::Polygon>(made, made.layout.polygons);
      for (std::size_t p = 0; p < polygons.size(); ++p) {
        if (polygons[p].sides == 0) continue;
        for (const auto& [b1, b2] : {std::pair{0.1F, 0.2F}, {0.7F, 0.1F}, {0.3F, 0.3F}, {0.05F, 0.9F}}) {
          protocol::Weights at{1 - b1 - b2, b1, b2};
          std::uint32_t leaf = protocol::find_leaf(nodes.data(), polygons[p].surface, at);
          if ((leaf & protocol::kKept) != 0) {
            if (protocol::keeper_of(leaf) != pe) {
              ++elsewhere;
              continue;
            }
            const protocol::KeptSurface& surface = kept.at(protocol::kept_place(leaf));
            EXPECT_EQ(surface.polygon, p);
            leaf = protocol::find_leaf(nodes.data(), surface.node, at);
          }
          const std::uint32_t first = irradiance_.first[mesh_.facet_at(polygons[p].number, b1, b2)];
          for (std::uint32_t side = 0; side < (polygons[p].sides == 3 ? 2U : 1U); ++side) {
            EXPECT_EQ(light.at(leaf + side).irradiance_over_pi, irradiance_.triangles[first + side].irradiance_over_pi);
          }
        }
      }
    }
    EXPECT_GT(elsewhere, 100U);
  }
}

// What is seen most goes to different PEs.
TEST_F(Keepers, ShareTheWorkEvenly) {
  Heat heat = heat_for(lists_.polygons);
  heat.surfaces.assign(mesh_.parts.size(), 1);
  for (std::uint32_t part = 0; part < kPes; ++part) heat.surfaces[part] = 1e6;
  const Placement placement = make_placement(
      mesh_, lists_, {{3, 2}, std::nullopt, "balanced", Scheme::spread},
      {Stage::ray_tracing, &heat, std::vector<bool>(lists_.grid.count(), true), std::vector<bool>(mesh_.parts.size())});
  std::vector<bool> busy(kPes);
  for (std::uint32_t part = 0; part < kPes; ++part) {
    EXPECT_FALSE(busy[placement.keeper_of_part[part]]);
    busy[placement.keeper_of_part[part]] = true;
  }
}

}  // namespace
}  // namespace torolux::test
