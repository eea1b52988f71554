// SPDX-License-Identifier: MIT
// Goes through the stores one by one and writes a PE's own numbers in place of the mesh's. Given the image of what all
// PEs have, it copies that and goes on from there.
#include "host_tools/layout/stage_image.hpp"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "emulator/errors.hpp"
#include "firmware/protocol/store_names.hpp"
#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/layout/copies.hpp"
#include "host_tools/layout/hemicube_weights.hpp"
#include "host_tools/layout/lamp_tables.hpp"
#include "host_tools/layout/sky_tables.hpp"

namespace torolux {
namespace {

using protocol::PeNumber;
using protocol::Store;

/// Where next to nothing of a facet is seen, its edges yet get some light: it must not count as ever so bright.
constexpr double kLeastSeen = 0.25;

class ImageWriter {
 public:
  ImageWriter(const Scene& scene, const Mesh& mesh, const Placement& placement, PeNumber pe, const LightUnits& units,
              const PeLayout& layout, const PeLoad* common)
      : scene_(scene),
        mesh_(mesh),
        placement_(placement),
        pe_(pe),
        units_(units),
        layout_(layout.layout),
        bytes_((layout.load_end - layout.layout.cell_words.address + 3) / 4 * 4) {
    if (common == nullptr) return;
    common_ = common->layout;
    next_node_ = common_.nodes.count;
    next_irradiance_ = common_.irradiance.count;
    copy_stores(*common);
  }

  std::vector<std::byte> radiosity() {
    write_subspaces();
    write_polygons(nullptr);
    write_patch_references();
    write_patch_parts();
    write_patches();
    if (common_.hemicube.count == 0)
      put_all<protocol::HemicubeEntry>(layout_.hemicube, make_hemicube_table(layout_.hemicube_size));
    write_sky();
    write_lamps();
    return std::move(bytes_);
  }

  std::vector<std::byte> ray_tracing(const VertexIrradiance& irradiance, const CameraTables& camera) {
    write_subspaces();
    write_textures();
    write_polygons(&irradiance);
    write_kept(irradiance);
    if (common_.emitters.count == 0 && layout_.emitters.count > 0)
      put_all<protocol::Emitter>(layout_.emitters, emitters(scene_, mesh_, units_));
    write_sky();
    write_lamps();
    if (common_.sample_places.count == 0 && layout_.sample_places.count > 0) {
      put_all<protocol::SamplePlace>(layout_.sample_places, camera.sample_places);
      put_all<float>(layout_.filter, camera.filter);
    }
    return std::move(bytes_);
  }

 private:
  void copy_stores(const PeLoad& common) {
    const auto from = protocol::store_extents(common.layout);
    const auto to = protocol::store_extents(layout_);
    for (std::size_t name = 0; name < from.size(); ++name) {
      if (protocol::StoreName{static_cast<std::uint32_t>(name)} == protocol::StoreName::record_slots) continue;
      if (from[name].store.count == 0) continue;
      const std::size_t at = to[name].store.address - layout_.cell_words.address;
      const std::size_t common_at = from[name].store.address - common.layout.cell_words.address;
      const auto size = static_cast<std::size_t>(from[name].bytes());
      if (from[name].store.count > to[name].store.count || at + size > bytes_.size()) {
        throw MachineFailure("a PE lacks what all have");
      }
      std::memcpy(bytes_.data() + at, common.image.data() + common_at, size);
    }
  }

  template <typename T>
  void put(const Store& store, std::size_t index, const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::size_t at = store.address - layout_.cell_words.address + index * sizeof(T);
    if (index >= store.count || at + sizeof(T) > bytes_.size()) throw MachineFailure("a store was laid out too small");
    std::memcpy(bytes_.data() + at, &value, sizeof(T));
  }
  template <typename T>
  void put_all(const Store& store, std::span<const T> values) {
    for (std::size_t i = 0; i < values.size(); ++i) put(store, i, values[i]);
  }

  std::uint32_t local_polygon(std::uint32_t triangle) const {
    const auto local = placement_.local_polygon(pe_, triangle);
    if (!local) throw MachineFailure("a patch lies outside its polygon");
    return *local;
  }

  void write_subspaces() {
    std::uint32_t first = common_.polygon_list.count;
    for (std::size_t local = common_.subspaces.count; local < placement_.cells_of_pe[pe_].size(); ++local) {
      const auto& entries = placement_.entries_of_cell[placement_.cells_of_pe[pe_][local]];
      put(layout_.subspaces, local, protocol::Subspace{first, static_cast<std::uint32_t>(entries.size())});
      for (protocol::ListedPolygon entry : entries) {
        if ((entry.polygon & protocol::kGroup) == 0) entry.polygon = local_polygon(entry.polygon);
        put(layout_.polygon_list, first++, entry);
      }
    }
    if (common_.cell_words.count == 0) write_cell_map();
    for (std::size_t local = placement_.common_cells; local < placement_.cells_of_pe[pe_].size(); ++local) {
      const CellIndex cell = placement_.cells_of_pe[pe_][local];
      put(layout_.cell_entries, entry_of(cell), protocol::held_as(static_cast<std::uint32_t>(local)));
    }
  }

  std::uint32_t entry_of(CellIndex cell) const {
    protocol::CellWord word{};
    std::memcpy(&word, bytes_.data() + cell / 32 * sizeof word, sizeof word);
    return protocol::entry_number(word, cell);
  }

  /// As of a PE without subspaces of its own.
  void write_cell_map() {
    std::vector<protocol::CellWord> words(layout_.cell_words.count);
    std::uint32_t entries = 0;
    for (CellIndex cell = 0; cell < placement_.grid.count(); ++cell) {
      if (cell % 32 == 0) words[cell / 32].before = entries;
      if (!placement_.stop_cell[cell]) continue;
      words[cell / 32].stops |= 1U << (cell % 32);
      const protocol::CellEntry entry = placement_.common_cell[cell] ? protocol::held_as(placement_.local_of_cell[cell])
                                                                     : protocol::CellEntry{placement_.pe_of_cell[cell]};
      put(layout_.cell_entries, entries++, entry);
    }
    put_all<protocol::CellWord>(layout_.cell_words, words);
  }

  /// irradiance: null in the radiosity stage.
  void write_polygons(const VertexIrradiance* irradiance) {
    const std::vector<std::uint32_t> textures = textures_of_pe(mesh_, placement_, pe_);
    for (std::uint32_t m = 0; m < mesh_.materials; ++m) {
      protocol::Material material = machine_material(scene_.materials[m], units_);
      const auto texture = std::lower_bound(textures.begin(), textures.end(), scene_.materials[m].texture);
      // Of a texture that none of its polygons shows, a PE has nothing.
      const bool shown = texture != textures.end() && *texture == scene_.materials[m].texture;
      if (irradiance != nullptr && shown) material.texture = static_cast<std::uint32_t>(texture - textures.begin());
      put(layout_.materials, m, material);
    }
    std::uint32_t normals = common_.normals.count;
    std::uint32_t texture_points = common_.texture_points.count;
    std::uint32_t references = common_.patch_references.count;
    for (std::size_t local = common_.polygons.count; local < placement_.polygons_of_pe[pe_].size(); ++local) {
      const std::uint32_t t = placement_.polygons_of_pe[pe_][local];
      const MeshTriangle& triangle = mesh_.triangles[t];
      protocol::Polygon polygon{};
      polygon.corner = triangle.corner;
      polygon.number = t;
      polygon.normals = protocol::kNoPolygon;
      if (triangle.normals != protocol::kNoPolygon) {
        polygon.normals = normals;
        for (std::uint32_t i = 0; i < 3; ++i) put(layout_.normals, normals++, mesh_.normals[triangle.normals + i]);
      }
      if (irradiance != nullptr && triangle.texture != protocol::kNoTexture) {
        polygon.texture_points = texture_points;
        for (std::uint32_t i = 0; i < 3; ++i) {
          put(layout_.texture_points, texture_points++, mesh_.texture_points[triangle.texture_points + i]);
        }
      }
      polygon.material = static_cast<std::uint16_t>(triangle.material);
      polygon.sides = triangle.sides;
      polygon.patch_level = triangle.patch_level;
      if (triangle.sides != 0) polygon.surface = irradiance != nullptr ? write_surface(*irradiance, t) : references;
      if (triangle.sides != 0) references += protocol::triangles_of_level(triangle.patch_level);
      put(layout_.polygons, local, polygon);
    }
  }

  void write_sky() {
    if (layout_.sky.count == 0 || common_.sky.count > 0) return;
    put_all<protocol::SkyEntry>(layout_.sky, sky_tables(scene_, units_).entries);
    if (layout_.sky_openings.count == 0) return;
    const std::vector<SkyInlet> inlets = sky_inlets(scene_, mesh_.space);
    for (std::size_t i = 0; i < inlets.size(); ++i) put(layout_.sky_openings, i, inlets[i].opening);
  }

  void write_lamps() {
    if (layout_.lamps.count == 0 || common_.lamps.count > 0) return;
    const LampTables tables = lamp_tables(scene_);
    put_all<protocol::Lamp>(layout_.lamps, tables.lamps);
    put_all<float>(layout_.lamp_values, tables.values);
    if (layout_.lamp_chances.count > 0) put_all<std::uint32_t>(layout_.lamp_chances, tables.chances);
  }

  void write_textures() {
    // All of the common textures are among a PE's.
    if (layout_.textures.count == common_.textures.count) return;
    std::uint32_t number = 0;
    std::uint32_t first = 0;
    for (const std::uint32_t from : textures_of_pe(mesh_, placement_, pe_)) {
      const MachineTexture& texture = mesh_.textures[from];
      put(layout_.textures, number++, protocol::Texture{texture.width, texture.height, first});
      for (const protocol::Texel texel : texture.texels) put(layout_.texels, first++, texel);
    }
  }

  /// Returns the node of the polygon's tree.
  std::uint32_t write_surface(const VertexIrradiance& irradiance, std::uint32_t t) {
    return write_polygon_tree(mesh_.triangles[t], 0, 0, [&](std::uint32_t part) {
      if (!placement_.has_keeper(part)) return write_irradiance(irradiance, part);
      return protocol::kept_leaf(placement_.keeper_of_part[part], placement_.place_of_part[part]);
    });
  }

  void write_kept(const VertexIrradiance& irradiance) {
    for (std::size_t place = 0; place < placement_.kept_by_pe[pe_].size(); ++place) {
      const std::uint32_t part = placement_.kept_by_pe[pe_][place];
      const std::uint32_t polygon = local_polygon(mesh_.facets[mesh_.parts[part].facet].triangle);
      put(layout_.kept, place, protocol::KeptSurface{polygon, write_irradiance(irradiance, part)});
    }
  }

  /// Returns the node of the part's tree.
  std::uint32_t write_irradiance(const VertexIrradiance& irradiance, std::uint32_t part) {
    const std::uint32_t facet = mesh_.parts[part].facet;
    const std::uint32_t sides = mesh_.triangles[mesh_.facets[facet].triangle].side_count();
    const std::uint32_t first = next_irradiance_;
    for (std::uint32_t i = 0; i < surface_size(mesh_, part).irradiance; ++i) {
      put(layout_.irradiance, next_irradiance_++, irradiance.triangles[irradiance.first[facet] + i]);
    }
    return write_tree(mesh_.parts[part].tree, [&](std::uint32_t leaf) { return first + leaf * sides; });
  }

  /// Nodes above the parts; part_node: makes the node of a part (Mesh::parts).
  template <typename PartNode>
  std::uint32_t write_polygon_tree(const MeshTriangle& triangle, std::uint32_t path, std::uint32_t level,
                                   const PartNode& part_node) {
    if (level == triangle.patch_level) return part_node(triangle.first_part + path);
    const std::uint32_t first = next_node_;
    next_node_ += 4;
    for (std::uint32_t child = 0; child < 4; ++child) {
      put(layout_.nodes, first + child, write_polygon_tree(triangle, path << 2U | child, level + 1, part_node));
    }
    return first;
  }

  /// number: of a leaf, from its place among the facets of the tree.
  template <typename Number>
  std::uint32_t write_tree(std::uint32_t node, const Number& number) {
    if ((node & protocol::kLeaf) != 0) return protocol::kLeaf | number(node & ~protocol::kLeaf);
    const std::uint32_t first = next_node_;
    next_node_ += 4;
    for (std::uint32_t child = 0; child < 4; ++child) {
      put(layout_.nodes, first + child, write_tree(mesh_.nodes[node + child], number));
    }
    return first;
  }

  void write_patch_references() {
    std::uint32_t next = common_.patch_references.count;
    for (std::size_t local = common_.polygons.count; local < placement_.polygons_of_pe[pe_].size(); ++local) {
      const std::uint32_t t = placement_.polygons_of_pe[pe_][local];
      const MeshTriangle& triangle = mesh_.triangles[t];
      if (triangle.sides == 0) continue;
      for (std::uint32_t path = 0; path < protocol::triangles_of_level(triangle.patch_level); ++path) {
        const MeshPart& part = mesh_.parts[triangle.first_part + path];
        put(layout_.patch_references, next++,
            protocol::PatchReference{placement_.local_of_part[triangle.first_part + path],
                                     placement_.patch_home[part.patch].pe, part.depth});
      }
    }
  }

  void write_patch_parts() {
    for (std::size_t local = 0; local < placement_.parts_of_pe[pe_].size(); ++local) {
      const MeshPart& part = mesh_.parts[placement_.parts_of_pe[pe_][local]];
      const std::uint32_t tree =
          write_tree(part.tree, [&](std::uint32_t leaf) { return mesh_.facets[part.facet + leaf].element; });
      put(layout_.patch_parts, local, protocol::PatchPart{placement_.patch_home[part.patch].local, tree});
    }
  }

  void write_patches() {
    std::uint32_t sides = 0;
    std::uint32_t elements = 0;
    std::uint32_t facets = 0;
    for (std::size_t local = 0; local < placement_.patches_of_pe[pe_].size(); ++local) {
      const std::uint32_t number = placement_.patches_of_pe[pe_][local];
      const MeshPatch& from = mesh_.patches[number];
      protocol::Patch patch{};
      patch.number = number;
      patch.first_facet = facets;
      patch.facets = from.facets;
      patch.elements = from.elements;
      patch.reflectance = from.reflectance;
      for (std::uint32_t f = 0; f < from.facets; ++f) write_facet(from, mesh_.facets[from.first_facet + f], facets++);
      for (std::uint32_t side = 0; side < 2; ++side) {
        patch.side[side] = protocol::kNoSide;
        if (from.side[side] == protocol::kNoSide) continue;
        protocol::PatchSide patch_side{};
        patch_side.emission = patch_emission(scene_, from, side, units_);
        for (std::size_t c = 0; c < 3; ++c) {
          patch_side.emits[c] = static_cast<float>(static_cast<double>(patch_side.emission[c]) /
                                                   (from.area * mesh_.space.scale * mesh_.space.scale));
        }
        patch_side.first_element = elements;
        elements += from.elements;
        patch.side[side] = sides;
        put(layout_.patch_sides, sides++, patch_side);
      }
      put(layout_.patches, local, patch);
    }
  }

  /// area: of the facet [user units^2].
  float lit_area(const MeshFacet& facet, double area) const {
    const double lit =
        (facet.is_piece ? area : area * std::max(facet.seen, kLeastSeen)) * mesh_.space.scale * mesh_.space.scale;
    return std::clamp(static_cast<float>(lit), protocol::kLeastLitArea, protocol::kMostLitArea);
  }

  void write_facet(const MeshPatch& patch, const MeshFacet& facet, std::uint32_t index) {
    const double area = mesh_.facet_area(facet);
    double of_element = facet.of_element;
    // Light that came beside a thing's foot must not leave under it. Where all is under it, next to nothing comes.
    if (!facet.sends_from) of_element *= 0x1p-20;
    // Never nothing, however small: a PE takes that for a mistake.
    const auto share = [](double value) { return std::max(static_cast<float>(value), 0x1p-100F); };
    put(layout_.facets, index,
        protocol::Facet{local_polygon(facet.triangle), facet.sends_from.value_or(facet.code), facet.element,
                        std::min(share(area / patch.area), 1.0F), std::min(share(of_element), 1.0F),
                        lit_area(facet, area)});
  }

  const Scene& scene_;
  const Mesh& mesh_;
  const Placement& placement_;
  PeNumber pe_;
  const LightUnits& units_;
  const protocol::StageLayout& layout_;
  protocol::StageLayout common_{};  ///< of what stands there already: its counts are where each store goes on
  std::uint32_t next_node_ = 0;
  std::uint32_t next_irradiance_ = 0;
  std::vector<std::byte> bytes_;  ///< elements stay zero
};

}  // namespace

std::vector<std::byte> radiosity_image(const Scene& scene, const Mesh& mesh, const Placement& placement, PeNumber pe,
                                       const LightUnits& units, const PeLayout& layout, const PeLoad* common) {
  return ImageWriter(scene, mesh, placement, pe, units, layout, common).radiosity();
}

std::vector<std::byte> ray_tracing_image(const Scene& scene, const Mesh& mesh, const Placement& placement, PeNumber pe,
                                         const LightUnits& units, const VertexIrradiance& irradiance,
                                         const PeLayout& layout, const CameraTables& camera, const PeLoad* common) {
  return ImageWriter(scene, mesh, placement, pe, units, layout, common).ray_tracing(irradiance, camera);
}

}  // namespace torolux
