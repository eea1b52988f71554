// SPDX-License-Identifier: MIT
// The stores by name: for what is done with all of them alike.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/protocol/stores.hpp"

namespace torolux::protocol {

/// In the order in which faults name them.
enum class StoreName : std::uint32_t {
  cell_words,
  cell_entries,
  subspaces,
  polygon_list,
  polygons,
  materials,
  normals,
  nodes,
  record_slots,
  patch_references,
  patch_parts,
  patches,
  patch_sides,
  elements,
  facets,
  hemicube,
  irradiance,
  kept,
  textures,
  texels,
  texture_points,
  sample_places,
  filter,
  emitters,
  sky,
  sky_openings,
  lamps,
  lamp_values,
  lamp_chances,
  count
};
inline constexpr std::uint32_t kStores = static_cast<std::uint32_t>(StoreName::count);

struct StoreExtent {
  Store store;
  std::uint32_t bytes_each;

  constexpr std::uint64_t bytes() const { return std::uint64_t{store.count} * bytes_each; }
  constexpr std::uint64_t end() const { return store.address + bytes(); }
};

/// By StoreName.
constexpr std::array<StoreExtent, kStores> store_extents(const StageLayout& l) {
  return {{
      {l.cell_words, sizeof(CellWord)},
      {l.cell_entries, sizeof(CellEntry)},
      {l.subspaces, sizeof(Subspace)},
      {l.polygon_list, sizeof(ListedPolygon)},
      {l.polygons, sizeof(Polygon)},
      {l.materials, sizeof(Material)},
      {l.normals, sizeof(Vec3f)},
      {l.nodes, sizeof(std::uint32_t)},
      {l.record_slots, slot_bytes(l.stage)},
      {l.patch_references, sizeof(PatchReference)},
      {l.patch_parts, sizeof(PatchPart)},
      {l.patches, sizeof(Patch)},
      {l.patch_sides, sizeof(PatchSide)},
      {l.elements, sizeof(Element)},
      {l.facets, sizeof(Facet)},
      {l.hemicube, sizeof(HemicubeEntry)},
      {l.irradiance, sizeof(CornerIrradiance)},
      {l.kept, sizeof(KeptSurface)},
      {l.textures, sizeof(Texture)},
      {l.texels, sizeof(Texel)},
      {l.texture_points, sizeof(TexturePoint)},
      {l.sample_places, sizeof(SamplePlace)},
      {l.filter, sizeof(float)},
      {l.emitters, sizeof(Emitter)},
      {l.sky, sizeof(SkyEntry)},
      {l.sky_openings, sizeof(SkyOpening)},
      {l.lamps, sizeof(Lamp)},
      {l.lamp_values, sizeof(float)},
      {l.lamp_chances, sizeof(std::uint32_t)},
  }};
}

}  // namespace torolux::protocol
