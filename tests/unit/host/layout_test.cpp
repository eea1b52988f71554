// SPDX-License-Identifier: MIT
// Layout: stores apart and aligned, every cross reference in the images right, flux of emitters whole, memory refused.
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <set>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/layout/stage_image.hpp"
#include "host_tools/layout/stage_layout.hpp"
#include "tests/unit/host/test_scenes.hpp"

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
    std::memcpy(&value, image.data() + store.address - layout.layout.subspaces.address + index * sizeof(T), sizeof(T));
    return value;
  }
};

class LayoutTest : public testing::Test {
 protected:
  LayoutTest() {
    for (unsigned pe = 0; pe < placement_.torus.pes(); ++pe) {
      Loaded loaded;
      loaded.layout = lay_out(mesh_, placement_, static_cast<protocol::PeNumber>(pe), Stage::radiosity, {}, kMap);
      loaded.image =
          radiosity_image(scene_, mesh_, placement_, static_cast<protocol::PeNumber>(pe), units_, loaded.layout);
      pes_.push_back(std::move(loaded));
    }
  }

  Scene scene_ = test::room_with_box();
  Mesh mesh_ = make_mesh(scene_, {.patch_length = 0.4, .element_length = 0.2});
  LightUnits units_ = light_units(scene_, mesh_, false);
  Placement placement_ = make_placement(mesh_, {{3, 2}, std::array<std::uint32_t, 3>{4, 4, 4}, "skewed", 1000});
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
    add(l.subspaces, sizeof(protocol::Subspace));
    add(l.polygon_list, sizeof(protocol::ListedPolygon));
    add(l.polygons, sizeof(protocol::Polygon));
    add(l.materials, sizeof(protocol::Material));
    add(l.patch_references, sizeof(protocol::PatchReference));
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
    EXPECT_EQ(l.record_slots.count, protocol::own_slots(Stage::radiosity) + 64);
    EXPECT_EQ(pe.image.size(), (pe.layout.load_end - l.subspaces.address + 3) / 4 * 4);
  }
}

TEST_F(LayoutTest, NeighboursPointBack) {
  std::size_t outer = 0;
  for (std::size_t pe = 0; pe < pes_.size(); ++pe) {
    const auto& store = pes_[pe].layout.layout.subspaces;
    for (std::uint32_t s = 0; s < store.count; ++s) {
      const auto subspace = pes_[pe].at<protocol::Subspace>(store, s);
      for (std::uint32_t face = 0; face < protocol::kFaces; ++face) {
        if (subspace.neighbour_pe[face] == protocol::kNobody) {
          ++outer;
          continue;
        }
        const Loaded& other = pes_[subspace.neighbour_pe[face]];
        const auto next = other.at<protocol::Subspace>(other.layout.layout.subspaces, subspace.neighbour[face]);
        EXPECT_EQ(next.neighbour_pe[face ^ 1U], pe);
        EXPECT_EQ(next.neighbour[face ^ 1U], s);
        EXPECT_EQ(next.cell[face / 2], subspace.cell[face / 2] + (face % 2 == 1 ? 1 : -1));
      }
    }
  }
  EXPECT_EQ(outer, 6U * 16U);
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
        const auto patch = owner.at<protocol::Patch>(owner.layout.layout.patches, reference.patch);
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

TEST_F(LayoutTest, RayTracingImageHoldsTheLatticeOfEachPolygon) {
  std::vector<protocol::Flux> flux(mesh_.elements);
  for (std::uint32_t e = 0; e < mesh_.elements; ++e) flux[e] = {1 + e * 1000003LL % 65537, 0, 0};
  const Lattice lattice = make_lattice(mesh_, flux, 1e-3, 1);
  for (protocol::PeNumber pe = 0; pe < placement_.torus.pes(); ++pe) {
    Loaded loaded;
    loaded.layout = lay_out(mesh_, placement_, pe, Stage::ray_tracing, {}, kMap);
    loaded.image = ray_tracing_image(scene_, mesh_, placement_, pe, units_, lattice, loaded.layout);
    const protocol::StageLayout& l = loaded.layout.layout;
    for (std::uint32_t p = 0; p < l.polygons.count; ++p) {
      const auto polygon = loaded.at<protocol::Polygon>(l.polygons, p);
      if (polygon.sides == 0) continue;
      std::vector<std::uint32_t> nodes;
      for (std::uint32_t n = 0; n < l.nodes.count; ++n) nodes.push_back(loaded.at<std::uint32_t>(l.nodes, n));
      for (const auto& [b1, b2] : {std::pair{0.1F, 0.2F}, {0.7F, 0.1F}, {0.3F, 0.3F}, {0.05F, 0.9F}}) {
        protocol::Weights at{1 - b1 - b2, b1, b2};
        const std::uint32_t leaf = protocol::find_leaf(nodes.data(), polygon.surface, at);
        const std::uint32_t first = lattice.first[mesh_.facet_at(polygon.number, b1, b2)];
        for (std::uint32_t side = 0; side < (polygon.sides == 3 ? 2U : 1U); ++side) {
          EXPECT_EQ(loaded.at<protocol::LatticeTriangle>(l.lattice, leaf + side).irradiance_over_pi,
                    lattice.triangles[first + side].irradiance_over_pi);
        }
      }
    }
  }
}

TEST_F(LayoutTest, MemoryIsChosenOrRefusedWithTheNumbers) {
  const MemoryNeed need = memory_need(mesh_, placement_, {}, kMap);
  EXPECT_EQ(choose_memory(need, {}), protocol::kDefaultLocalMemory);
  EXPECT_EQ(choose_memory(need, static_cast<std::uint32_t>(need.most())), need.most());
  EXPECT_EQ(choose_memory(need, static_cast<std::uint32_t>(need.most() - 1)), std::nullopt);
  const std::string refusal = need.refusal(100'000);
  EXPECT_NE(refusal.find("PE " + std::to_string(need.fullest) + " needs " + with_commas(need.most()) + " bytes"),
            std::string::npos)
      << refusal;
  EXPECT_NE(refusal.find("has 100,000"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("--pe-memory 256K"), std::string::npos) << refusal;
}

TEST(WithCommas, GroupsByThree) {
  EXPECT_EQ(with_commas(0), "0");
  EXPECT_EQ(with_commas(999), "999");
  EXPECT_EQ(with_commas(1000), "1,000");
  EXPECT_EQ(with_commas(1234567), "1,234,567");
}

}  // namespace
}  // namespace torolux
