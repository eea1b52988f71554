// SPDX-License-Identifier: MIT
// Layout: stores apart and aligned, every cross reference in the images right, flux of emitters whole, memory refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/layout/stage_image.hpp"
#include "host_tools/layout/stage_layout.hpp"
#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux {
namespace {

using protocol::Stage;

constexpr MemoryMap kMap{protocol::kLocalMemoryBase + 100'004, 64};

struct Loaded {
  PeLayout layout;
  std::vector<std::byte> image;
  template <typename T>
  T at(const protocol::Store& store, std::size_t index) const {
    EXPECT_LT(index, store.count);
    T value{};
    std::memcpy(&value, image.data() + store.address - layout.layout.cell_words.address + index * sizeof(T), sizeof(T));
    return value;
  }
};

class LayoutTest : public testing::Test {
 protected:
  LayoutTest() {
    for (unsigned pe = 0; pe < placement_.torus.pes(); ++pe) {
      Loaded loaded;
      loaded.layout = lay_out(mesh_, placement_, static_cast<protocol::PeNumber>(pe), Stage::radiosity,
                              test::stage_parameters(), kMap);
      loaded.image =
          radiosity_image(scene_, mesh_, placement_, static_cast<protocol::PeNumber>(pe), units_, loaded.layout);
      pes_.push_back(std::move(loaded));
    }
  }

  Scene scene_ = test::room_with_box();
  Mesh mesh_ = make_mesh(scene_, {.patch_length = 0.4, .element_length = 0.2});
  LightUnits units_ = light_units(scene_, mesh_, false);
  Placement placement_ = make_placement(mesh_, {{3, 2}, std::array<std::uint32_t, 3>{6, 5, 7}, "skewed"});
  std::vector<Loaded> pes_;
};

TEST_F(LayoutTest, StoresAreAlignedAndApart) {
  for (const Loaded& pe : pes_) {
    const protocol::StageLayout& l = pe.layout.layout;
    std::map<std::uint64_t, std::uint64_t> ranges;
    const auto add = [&ranges](const protocol::Store& store, std::size_t bytes) {
      EXPECT_EQ(store.address % 8, 0U);
      if (store.count == 0) return;
      EXPECT_TRUE(ranges.emplace(store.address, store.address + store.count * bytes).second);
    };
    add(l.cell_words, sizeof(protocol::CellWord));
    add(l.cell_entries, sizeof(protocol::CellEntry));
    add(l.subspaces, sizeof(protocol::Subspace));
    add(l.polygon_list, sizeof(protocol::ListedPolygon));
    add(l.polygons, sizeof(protocol::Polygon));
    add(l.materials, sizeof(protocol::Material));
    add(l.patch_references, sizeof(protocol::PatchReference));
    add(l.patch_parts, sizeof(protocol::PatchPart));
    add(l.patches, sizeof(protocol::Patch));
    add(l.patch_sides, sizeof(protocol::PatchSide));
    add(l.elements, sizeof(protocol::Element));
    add(l.hemicube, sizeof(protocol::HemicubeEntry));
    add(l.record_slots, sizeof(protocol::RadiosityRecord));
    std::uint64_t last = kMap.stores_begin;
    for (const auto& [begin, end] : ranges) {
      EXPECT_GE(begin, last);
      last = end;
    }
    EXPECT_EQ(last, pe.layout.end);
    EXPECT_EQ(l.record_slots.count, protocol::own_slots(Stage::radiosity, 8) + 64)
        << "a batch for each of six PEs, rounded up to a power of two";
    EXPECT_EQ(pe.image.size(), (pe.layout.load_end - l.cell_words.address + 3) / 4 * 4);
  }
}

/// Each cell's entry in a PE's map; nothing where no ray stops.
std::vector<std::optional<protocol::CellEntry>> map_of(const Loaded& pe, CellIndex cells) {
  const protocol::StageLayout& l = pe.layout.layout;
  std::vector<std::optional<protocol::CellEntry>> map(cells);
  std::uint32_t entries = 0;
  for (CellIndex cell = 0; cell < cells; ++cell) {
    const auto word = pe.at<protocol::CellWord>(l.cell_words, cell / 32);
    if (cell % 32 == 0) {
      EXPECT_EQ(word.before, entries);
    }
    if (((word.stops >> (cell % 32)) & 1U) != 0) map[cell] = pe.at<protocol::CellEntry>(l.cell_entries, entries++);
  }
  EXPECT_EQ(entries, l.cell_entries.count);
  return map;
}

// Scheme `paper`: rays stop everywhere, and nobody has copies. Scheme `spread`: where something stands; every third of
// those cells is on all PEs here, under the same number.
TEST_F(LayoutTest, MapsNameWhoHoldsWhatStandsInEachCell) {
  const Grid& grid = placement_.grid;
  std::vector<bool> common(grid.count());
  for (CellIndex cell = 0; cell < grid.count(); cell += 3) common[cell] = !placement_.polygons_of_cell[cell].empty();
  for (const Scheme scheme : {Scheme::paper, Scheme::spread}) {
    const Placement placement = make_placement(mesh_, list_cells(mesh_, grid),
                                               {.torus = {3, 2},
                                                .subspaces = {},
                                                .allocation = scheme == Scheme::paper ? "skewed" : "balanced",
                                                .scheme = scheme},
                                               {.common_cell = scheme == Scheme::paper ? std::vector<bool>() : common});
    EXPECT_LT(placement.filled_cells, grid.count());
    EXPECT_EQ(placement.stops, scheme == Scheme::paper ? grid.count() : placement.filled_cells);
    std::map<CellIndex, std::set<protocol::CellEntry>> numbers;  ///< of common cells
    for (protocol::PeNumber pe = 0; pe < 6; ++pe) {
      Loaded loaded;
      loaded.layout = lay_out(mesh_, placement, pe, Stage::radiosity, test::stage_parameters(), kMap);
      loaded.image = radiosity_image(scene_, mesh_, placement, pe, units_, loaded.layout);
      const protocol::StageLayout& l = loaded.layout.layout;
      const auto map = map_of(loaded, grid.count());
      std::set<protocol::CellEntry> held;
      for (CellIndex cell = 0; cell < grid.count(); ++cell) {
        const auto& polygons = placement.polygons_of_cell[cell];
        ASSERT_EQ(map[cell].has_value(), scheme == Scheme::paper || !polygons.empty());
        if (!map[cell]) continue;
        if (placement.pe_of_cell[cell] != pe && !placement.common_cell[cell]) {
          EXPECT_EQ(*map[cell], placement.pe_of_cell[cell]);
          continue;
        }
        ASSERT_NE(*map[cell] & protocol::kHeld, 0U);
        held.insert(*map[cell]);
        if (placement.common_cell[cell]) numbers[cell].insert(*map[cell]);
        const auto subspace = loaded.at<protocol::Subspace>(l.subspaces, *map[cell] & ~protocol::kHeld);
        std::vector<std::uint32_t> listed;
        for (std::uint32_t i = 0; i < subspace.polygon_count; ++i) {
          const auto entry = loaded.at<protocol::ListedPolygon>(l.polygon_list, subspace.first_polygon + i);
          if ((entry.polygon & protocol::kGroup) != 0) continue;
          listed.push_back(loaded.at<protocol::Polygon>(l.polygons, entry.polygon).number);
        }
        std::sort(listed.begin(), listed.end());
        EXPECT_EQ(listed, polygons);
      }
      EXPECT_EQ(held.size(), l.subspaces.count) << "each under a number of its own";
    }
    EXPECT_EQ(numbers.empty(), scheme == Scheme::paper);
    for (const auto& [cell, of_all] : numbers) EXPECT_EQ(of_all.size(), 1U) << "cell " << cell;
  }
}

TEST_F(LayoutTest, ReferencesNameTheOwnersPatch) {
  std::set<std::uint32_t> owned;
  for (const Loaded& pe : pes_) {
    const protocol::StageLayout& l = pe.layout.layout;
    for (std::uint32_t p = 0; p < l.polygons.count; ++p) {
      const auto polygon = pe.at<protocol::Polygon>(l.polygons, p);
      for (std::uint32_t path = 0; path < protocol::triangles_of_level(polygon.patch_level); ++path) {
        const auto reference = pe.at<protocol::PatchReference>(l.patch_references, polygon.surface + path);
        const Loaded& owner = pes_[reference.pe];
        const auto owned_part = owner.at<protocol::PatchPart>(owner.layout.layout.patch_parts, reference.part);
        const auto patch = owner.at<protocol::Patch>(owner.layout.layout.patches, owned_part.patch);
        const MeshPart& part = mesh_.parts[mesh_.triangles[polygon.number].first_part + path];
        EXPECT_EQ(patch.number, part.patch);
        const auto facet = owner.at<protocol::Facet>(owner.layout.layout.facets, patch.first_facet);
        EXPECT_EQ(owner.at<protocol::Polygon>(owner.layout.layout.polygons, facet.polygon).number, polygon.number);
        owned.insert(patch.number);
      }
    }
  }
  EXPECT_EQ(owned.size(), mesh_.patches.size());
}

TEST_F(LayoutTest, PatchesShareOutElementsAndEmission) {
  std::uint64_t elements = 0;
  std::uint64_t sides = 0;
  std::int64_t red = 0;
  for (const Loaded& pe : pes_) {
    const protocol::StageLayout& l = pe.layout.layout;
    std::uint32_t next = 0;
    for (std::uint32_t p = 0; p < l.patches.count; ++p) {
      const auto patch = pe.at<protocol::Patch>(l.patches, p);
      for (const std::uint32_t s : patch.side) {
        if (s == protocol::kNoSide) continue;
        const auto side = pe.at<protocol::PatchSide>(l.patch_sides, s);
        EXPECT_EQ(side.first_element, next);
        next += patch.elements;
        red += side.emission[0];
        ++sides;
      }
    }
    EXPECT_EQ(next, l.elements.count);
    elements += next;
  }
  EXPECT_EQ(elements, mesh_.elements);
  EXPECT_EQ(sides, mesh_.patch_sides);
  // The greatest channel's emitted flux is 2^48 quanta, but for rounding of each patch by half a quantum.
  EXPECT_NEAR(static_cast<double>(red), 0x1p48, static_cast<double>(mesh_.patches.size()));
}

TEST_F(LayoutTest, RayTracingImageHoldsTheIrradianceOfEachPolygon) {
  std::vector<protocol::Flux> flux(mesh_.elements);
  for (std::uint32_t e = 0; e < mesh_.elements; ++e) flux[e] = {1 + e * 1000003LL % 65537, 0, 0};
  const VertexIrradiance irradiance = make_vertex_irradiance(mesh_, flux, 1e-3, 1);
  for (protocol::PeNumber pe = 0; pe < placement_.torus.pes(); ++pe) {
    Loaded loaded;
    loaded.layout = lay_out(mesh_, placement_, pe, Stage::ray_tracing, test::stage_parameters(), kMap);
    loaded.image = ray_tracing_image(scene_, mesh_, placement_, pe, units_, irradiance, loaded.layout);
    const protocol::StageLayout& l = loaded.layout.layout;
    for (std::uint32_t p = 0; p < l.polygons.count; ++p) {
      const auto polygon = loaded.at<protocol::Polygon>(l.polygons, p);
      if (polygon.sides == 0) continue;
      std::vector<std::uint32_t> nodes;
      for (std::uint32_t n = 0; n < l.nodes.count; ++n) nodes.push_back(loaded.at<std::uint32_t>(l.nodes, n));
      for (const auto& [b1, b2] : {std::pair{0.1F, 0.2F}, {0.7F, 0.1F}, {0.3F, 0.3F}, {0.05F, 0.9F}}) {
        protocol::Weights at{1 - b1 - b2, b1, b2};
        const std::uint32_t leaf = protocol::find_leaf(nodes.data(), polygon.surface, at);
        const std::uint32_t first = irradiance.first[mesh_.facet_at(polygon.number, b1, b2)];
        for (std::uint32_t side = 0; side < (polygon.sides == 3 ? 2U : 1U); ++side) {
          EXPECT_EQ(loaded.at<protocol::CornerIrradiance>(l.irradiance, leaf + side).irradiance_over_pi,
                    irradiance.triangles[first + side].irradiance_over_pi);
        }
      }
    }
  }
}

TEST_F(LayoutTest, MemoryIsChosenOrRefusedWithTheNumbers) {
  const MemoryNeed need = memory_need(mesh_, placement_, placement_, test::stage_parameters(), kMap);
  EXPECT_EQ(choose_memory(need, {}), protocol::kDefaultLocalMemory);
  EXPECT_EQ(choose_memory(need, static_cast<std::uint32_t>(need.most())), need.most());
  EXPECT_EQ(choose_memory(need, static_cast<std::uint32_t>(need.most() - 1)), std::nullopt);
  const std::string refusal = need.refusal(100'000);
  EXPECT_NE(refusal.find("PE " + std::to_string(need.fullest) + " needs " + with_commas(need.most()) + " bytes"),
            std::string::npos)
      << refusal;
  EXPECT_NE(refusal.find("has 100,000"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("(fixed: image 100,004, record slots "), std::string::npos) << "largest first: " << refusal;
  EXPECT_NE(refusal.find("; less by greater --elements: irradiance "), std::string::npos) << refusal;
  std::uint64_t all = 0;
  for (const StoreBytes& store : need.fullest_stores) all += store.bytes;
  EXPECT_LE(all, need.most());
  EXPECT_GT(all + 8 * need.fullest_stores.size(), need.most()) << "but for what stores are aligned by";
}

TEST(WithCommas, GroupsByThree) {
  EXPECT_EQ(with_commas(0), "0");
  EXPECT_EQ(with_commas(999), "999");
  EXPECT_EQ(with_commas(1000), "1,000");
  EXPECT_EQ(with_commas(1234567), "1,234,567");
}

}  // namespace
}  // namespace torolux
