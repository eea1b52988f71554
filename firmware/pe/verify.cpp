// SPDX-License-Identifier: MIT
// Checks every index in the stores once, before a stage begins: the handlers trust them afterwards.
#include <bit>
#include <cstddef>

#include "firmware/pe/pe.hpp"
#include "firmware/protocol/fault_fields.hpp"
#include "firmware/protocol/triangle_grid.hpp"

namespace torolux::pe {
namespace {

using protocol::Polygon;
using protocol::Stage;
using protocol::StoreIndex;
using protocol::Subspace;

class Verifier {
 public:
  Verifier(Niu& niu, const Scene& scene) : niu_(niu), scene_(scene) {}

  void all() {
    check_map();
    for (const Subspace& subspace : scene_.subspaces) check(subspace);
    for (const Polygon& polygon : scene_.polygons) check(polygon);
    for (const protocol::KeptSurface& kept : scene_.kept) below(StoreIndex::kept, kept.polygon, scene_.polygons.size());
    for (const protocol::Material& material : scene_.materials) check(material);
    check_textures();
    check_emitters();
    check_sky();
    for (const protocol::Lamp& lamp : scene_.lamps)
      for (const protocol::LampSide& side : lamp.side) check(side);
    if (scene_.layout.stage != Stage::radiosity) return;
    for (const protocol::PatchPart& part : scene_.patch_parts) check(part);
    for (const protocol::Patch& patch : scene_.patches) check(patch);
    check_hemicube();
  }

 private:
  void require(bool holds, StoreIndex index, std::uint32_t value, std::size_t limit) {
    if (!holds) {
      niu_.fail(FaultCode::outside_store, static_cast<std::uint32_t>(index), value, static_cast<std::uint32_t>(limit));
    }
  }
  void below(StoreIndex index, std::uint32_t value, std::size_t limit) { require(value < limit, index, value, limit); }
  /// count items from `first` on.
  void range(StoreIndex index, std::uint32_t first, std::uint32_t count, std::size_t limit) {
    require(first <= limit && count <= limit - first, index, first, limit);
  }

  void check(const Subspace& s) {
    range(StoreIndex::polygon_list, s.first_polygon, s.polygon_count, scene_.polygon_list.size());
    const auto list = scene_.polygon_list.subspan(s.first_polygon, s.polygon_count);
    // All of them in groups, or none.
    const bool grouped = !list.empty() && (list[0].polygon & protocol::kGroup) != 0;
    for (std::size_t i = 0, group = 0; i < list.size(); ++i) {
      if (grouped && group == 0) {
        require((list[i].polygon & protocol::kGroup) != 0, StoreIndex::group, list[i].polygon, 0);
        group = list[i].polygon & ~protocol::kGroup;
        require(group >= 1 && group < list.size() - i, StoreIndex::group, list[i].polygon, list.size());
        continue;
      }
      below(StoreIndex::polygon, list[i].polygon, scene_.polygons.size());
      if (group > 0) --group;
    }
  }
  /// Every bit has an entry, and every entry a subspace here or another PE: so a walk always ends.
  void check_map() {
    const auto& cells = scene_.layout.cells;
    const std::uint32_t count = cells[0] * cells[1] * cells[2];
    require(scene_.map.words.size() == protocol::cell_words(count), StoreIndex::cell_words, count,
            scene_.map.words.size());
    std::uint32_t entries = 0;
    for (const protocol::CellWord& word : scene_.map.words) {
      require(word.before == entries, StoreIndex::cell_rank, word.before, entries);
      entries += static_cast<std::uint32_t>(std::popcount(word.stops));
    }
    const std::uint32_t beyond = count % 32U == 0 ? 0 : scene_.map.words.back().stops >> (count % 32U);
    require(beyond == 0, StoreIndex::cell_beyond, beyond, count);
    require(scene_.map.entries.size() == entries, StoreIndex::cell_entries, entries, scene_.map.entries.size());
    for (const protocol::CellEntry entry : scene_.map.entries) {
      if ((entry & protocol::kHeld) != 0) {
        below(StoreIndex::cell_holder, entry & ~protocol::kHeld, scene_.subspaces.size());
      } else {
        require(entry < niu_.pes() && entry != niu_.pe(), StoreIndex::cell_holder, entry, niu_.pes());
      }
    }
  }

  /// Inside the unit cube but for rounding; not a number fails, too.
  void check_corners(const std::array<protocol::Vec3f, 3>& corners, StoreIndex index, std::uint32_t number) {
    for (const protocol::Vec3f& corner : corners) {
      for (const float x : corner) {
        // -2^-20 <= x <= 1 + 2^-20, by its bits: those of floats of one sign are in the order of their sizes.
        const auto u = std::bit_cast<std::uint32_t>(x);
        constexpr auto most = std::bit_cast<std::uint32_t>(1.0F + 0x1p-20F);
        constexpr auto below_0 = std::bit_cast<std::uint32_t>(0x1p-20F);
        constexpr auto sign = std::bit_cast<std::uint32_t>(-0.0F);
        require(u <= most || u - sign <= below_0, index, number, 1);
      }
    }
  }

  void check_textures() {
    for (const protocol::Texture& texture : scene_.textures) {
      const bool fits = texture.width >= 1 && texture.width <= protocol::kMostTextureEdge && texture.height >= 1 &&
                        texture.height <= protocol::kMostTextureEdge;
      require(fits, StoreIndex::texture_size, texture.width, texture.height);
      range(StoreIndex::texels, texture.first_texel, texture.width * texture.height, scene_.texels.size());
    }
    for (const protocol::TexturePoint& point : scene_.texture_points) {
      constexpr float most = protocol::kMostTexturePoint;
      const bool near = point.u >= -most && point.u <= most && point.v >= -most && point.v <= most;
      require(near, StoreIndex::texture_point, 0, 0);
    }
  }

  /// All of it or nothing; so a drawn word finds an entry.
  void check_sky() {
    const auto entries = static_cast<std::uint32_t>(scene_.sky.size());
    require(entries == 0 || entries == protocol::kSkyEntries, StoreIndex::sky_entries, entries, protocol::kSkyEntries);
    std::uint32_t before = 0;
    for (const protocol::SkyEntry& entry : scene_.sky) {
      require(entry.chosen_to >= before, StoreIndex::sky_chance, entry.chosen_to, before);
      before = entry.chosen_to;
    }
    require(entries == 0 || before == 0xFFFF'FFFFU, StoreIndex::sky_chance, before, 0xFFFF'FFFFU);
    for (const protocol::Emitter& emitter : scene_.emitters) {
      require(emitter.polygon != protocol::kSkyTarget || entries > 0, StoreIndex::sky_entries, 0,
              protocol::kSkyEntries);
    }
    for (std::uint32_t i = 0; i < scene_.sky_openings.size(); ++i) {
      const protocol::SkyOpening& opening = scene_.sky_openings[i];
      const auto sum = [](const protocol::Vec3f& a, const protocol::Vec3f& b) {
        return protocol::Vec3f{a[0] + b[0], a[1] + b[1], a[2] + b[2]};
      };
      const protocol::Vec3f beside = sum(opening.corner, opening.along);
      check_corners({opening.corner, beside, sum(beside, opening.across)}, StoreIndex::sky_opening, i);
    }
  }

  void lamp_below(std::uint32_t lamp) {
    if (lamp != protocol::kNoLamp) below(StoreIndex::lamp, lamp, scene_.lamps.size());
  }
  void check(const protocol::LampSide& side) {
    if (side.bands == 0) return;
    const bool fits =
        side.bands <= protocol::kMostLampBands && side.sectors >= 1U && side.sectors <= protocol::kMostLampSectors;
    require(fits, StoreIndex::lamp_size, side.bands, side.sectors);
    range(StoreIndex::lamp_table, side.heights, side.bands + 1U, scene_.lamp_values.size());
    range(StoreIndex::lamp_table, side.values, (side.bands + 1U) * side.sectors, scene_.lamp_values.size());
    if (scene_.layout.stage != Stage::radiosity) return;
    const std::uint32_t cells = side.bands * side.sectors;
    range(StoreIndex::lamp_table, side.chances, cells, scene_.lamp_chances.size());
    std::uint32_t before = 0;
    for (const std::uint32_t chosen_to : scene_.lamp_chances.subspan(side.chances, cells)) {
      require(chosen_to >= before, StoreIndex::lamp_chance, chosen_to, before);
      before = chosen_to;
    }
    require(before == 0xFFFF'FFFFU, StoreIndex::lamp_chance, before, 0xFFFF'FFFFU);
  }

  /// Whatever the random bits are, one of them is chosen.
  void check_emitters() {
    std::uint32_t before = 0;
    for (const protocol::Emitter& emitter : scene_.emitters) {
      check_corners(emitter.corner, StoreIndex::emitter_corner, emitter.polygon);
      lamp_below(emitter.lamp);
      require(emitter.chosen_to >= before, StoreIndex::emitter_chance, emitter.chosen_to, before);
      before = emitter.chosen_to;
    }
    require(scene_.emitters.empty() || before == 0xFFFF'FFFFU, StoreIndex::emitter_chance, before, 0xFFFF'FFFFU);
  }

  void check(const Polygon& p) {
    check_corners(p.corner, StoreIndex::corner, p.number);
    below(StoreIndex::material, p.material, scene_.materials.size());
    if (p.normals != protocol::kNoPolygon) range(StoreIndex::normals, p.normals, 3, scene_.normals.size());
    require(p.patch_level <= protocol::kMostLevels, StoreIndex::level, p.patch_level, protocol::kMostLevels);
    if (scene_.layout.stage == Stage::ray_tracing && scene_.materials[p.material].texture != protocol::kNoTexture) {
      range(StoreIndex::texture_points, p.texture_points, 3, scene_.texture_points.size());
    }
    if (p.sides == 0) return;
    require(p.sides <= (protocol::kFrontPresent | protocol::kBackPresent), StoreIndex::lit_sides, p.sides, 3);
    if (scene_.layout.stage == Stage::radiosity) {
      const std::uint32_t patches = protocol::triangles_of_level(p.patch_level);
      range(StoreIndex::surface, p.surface, patches, scene_.patch_references.size());
      for (std::uint32_t i = 0; i < patches; ++i) check(p, scene_.patch_references[p.surface + i]);
    } else {
      check_surface(p.surface, irradiance_limit(p.sides == 3U ? 2 : 1), 0);
    }
  }
  /// Of a leaf's number: corner irradiances of all lit sides, the back's behind the front's, follow it.
  std::size_t irradiance_limit(std::size_t sides) const {
    return scene_.irradiance.size() >= sides ? scene_.irradiance.size() - sides + 1 : 0;
  }
  /// As check_tree; a leaf may stand for a part that is kept, here or elsewhere.
  void check_surface(std::uint32_t node, std::size_t limit, std::uint32_t depth) {
    if ((node & protocol::kLeaf) == 0) {
      require(depth < protocol::kMostLevels, StoreIndex::tree_depth, node, protocol::kMostLevels);
      range(StoreIndex::node, node, 4, scene_.nodes.size());
      for (const std::uint32_t child : scene_.nodes.subspan(node, 4)) {
        if ((child & (protocol::kLeaf | protocol::kKept)) == protocol::kLeaf) {
          below(StoreIndex::leaf, child & ~protocol::kLeaf, limit);
        } else {
          check_surface(child, limit, depth + 1U);
        }
      }
    } else if ((node & protocol::kKept) == 0) {
      below(StoreIndex::leaf, node & ~protocol::kLeaf, limit);
    } else {
      below(StoreIndex::kept, protocol::keeper_of(node), niu_.pes());
      if (protocol::keeper_of(node) != niu_.pe()) return;
      below(StoreIndex::kept, protocol::kept_place(node), scene_.kept.size());
      check_tree(scene_.kept[protocol::kept_place(node)].node, limit, depth);
    }
  }
  /// Every leaf below `limit`, and no deeper than a polygon is ever cut.
  void check_tree(std::uint32_t node, std::size_t limit, std::uint32_t depth) {
    if ((node & protocol::kLeaf) != 0) {
      below(StoreIndex::leaf, node & ~protocol::kLeaf, limit);
      return;
    }
    require(depth < protocol::kMostLevels, StoreIndex::tree_depth, node, protocol::kMostLevels);
    range(StoreIndex::node, node, 4, scene_.nodes.size());
    for (const std::uint32_t child : scene_.nodes.subspan(node, 4)) {
      // Four out of five are leaves: no call for those.
      if ((child & protocol::kLeaf) != 0) {
        below(StoreIndex::leaf, child & ~protocol::kLeaf, limit);
      } else {
        check_tree(child, limit, depth + 1U);
      }
    }
  }
  /// Where this PE owns the patch, it has the sides that the polygon promises. Of another PE's only that PE knows.
  void check(const Polygon& p, const protocol::PatchReference& reference) {
    below(StoreIndex::reference_pe, reference.pe, niu_.pes());
    require(reference.levels <= protocol::kMostLevels, StoreIndex::level, reference.levels, protocol::kMostLevels);
    if (reference.pe != niu_.pe()) return;
    below(StoreIndex::reference_part, reference.part, scene_.patch_parts.size());
    const std::uint32_t number = scene_.patch_parts[reference.part].patch;
    below(StoreIndex::patch, number, scene_.patches.size());
    for (std::uint32_t side = 0; side < 2; ++side) {
      const bool promised = (p.sides & (1U << side)) != 0;
      require(!promised || scene_.patches[number].side[side] != protocol::kNoSide, StoreIndex::reference_side, number,
              side);
    }
  }
  void check(const protocol::PatchPart& part) {
    below(StoreIndex::patch, part.patch, scene_.patches.size());
    check_tree(part.tree, scene_.patches[part.patch].elements, 0);
  }

  void check(const protocol::Material& material) {
    require(material.kind <= protocol::MaterialKind::pane, StoreIndex::material_kind,
            static_cast<std::uint32_t>(material.kind), static_cast<std::uint32_t>(protocol::MaterialKind::pane));
    const bool glass = material.kind == protocol::MaterialKind::glass || material.kind == protocol::MaterialKind::pane;
    const bool bends = !glass || material.refractive_index > 0.0F;
    require(bends, StoreIndex::refractive_index, 0, 0);
    const bool spreads =
        material.kind != protocol::MaterialKind::glossy || (material.lobe_power > 0.0F && material.lobe_power <= 1.0F);
    require(spreads, StoreIndex::lobe, 0, 1);
    lamp_below(material.lamp);
    if (scene_.layout.stage == Stage::ray_tracing && material.texture != protocol::kNoTexture) {
      below(StoreIndex::texture, material.texture, scene_.textures.size());
    }
  }

  void check(const protocol::Patch& patch) {
    require(patch.facets > 0, StoreIndex::no_facets, patch.number, 0);
    range(StoreIndex::facet, patch.first_facet, patch.facets, scene_.facets.size());
    for (const protocol::Facet& facet : scene_.facets.subspan(patch.first_facet, patch.facets)) check(patch, facet);
    for (const std::uint32_t side : patch.side) {
      if (side == protocol::kNoSide) continue;
      below(StoreIndex::patch_side, side, scene_.patch_sides.size());
      range(StoreIndex::first_element, scene_.patch_sides[side].first_element, patch.elements, scene_.elements.size());
    }
  }
  void check(const protocol::Patch& patch, const protocol::Facet& facet) {
    below(StoreIndex::facet_polygon, facet.polygon, scene_.polygons.size());
    const bool code = facet.code >= 1U && facet.code < 2U * protocol::triangles_of_level(protocol::kMostLevels) &&
                      facet.code < 2U * protocol::triangles_of_level(protocol::level_of_code(facet.code));
    require(code, StoreIndex::facet_code, facet.code, protocol::kMostLevels);
    below(StoreIndex::facet_element, facet.element, patch.elements);
    for (const float share : {facet.of_patch, facet.of_element}) {
      require(share > 0.0F && share <= 1.0F, StoreIndex::facet_share, facet.polygon, 1);
    }
    require(facet.lit_area >= protocol::kLeastLitArea && facet.lit_area <= protocol::kMostLitArea, StoreIndex::lit_area,
            facet.polygon, 0);
  }

  void check_hemicube() {
    const std::uint32_t n = scene_.layout.hemicube_size;
    const std::uint32_t top = n / 2U * (n / 2U);
    std::uint64_t sum = 0;
    for (std::uint32_t i = 0; i < scene_.hemicube.size(); ++i)
      sum += scene_.hemicube[i].weight * (i < top ? 4ULL : 8ULL);
    require(sum == protocol::kOne, StoreIndex::hemicube_sum, static_cast<std::uint32_t>(sum),
            static_cast<std::uint32_t>(sum >> 32U));
  }

  Niu& niu_;
  const Scene& scene_;
};

}  // namespace

void verify_stores(Niu& niu, const Scene& scene) {
  Verifier(niu, scene).all();
}

}  // namespace torolux::pe
