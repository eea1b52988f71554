// SPDX-License-Identifier: MIT
// What a PE found wrong, by name: first details of the fault codes. Numbers and words of one list stand side by side,
// so that the host can say what a PE only numbers. A fault is no part of a layout: new ones go to the end.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "firmware/protocol/store_names.hpp"

namespace torolux::protocol {

/// FaultCode::outside_store: which index; its value and the limit follow.
enum class StoreIndex : std::uint32_t {
  cell_words,
  cell_rank,
  cell_beyond,
  cell_entries,
  cell_holder,
  polygon_list,
  polygon,
  group,
  corner,
  material,
  material_kind,
  normals,
  level,
  surface,
  tree_depth,
  node,
  leaf,
  kept,
  reference_pe,
  reference_part,
  patch,
  reference_side,
  facet,
  facet_polygon,
  facet_code,
  facet_element,
  facet_share,
  patch_side,
  first_element,
  hemicube_sum,
  refractive_index,
  lobe,
  texture,
  texture_size,
  texture_points,
  texture_point,
  emitter_corner,
  emitter_chance,
  // What the host's messages ask for
  load_address,
  load_offset,
  select_count,
  shoot_patch,
  shoot_side,
  shoot_kind,
  shoot_amount,
  deal,
  tile_places,
  tile_columns,
  tile_rows,
  count
};
inline constexpr std::array<std::string_view, static_cast<std::size_t>(StoreIndex::count)> kStoreIndexNames = {
    "words of the map of cells, of so many cells",
    "entries before a word of the map of cells",
    "bits of the map of cells beyond its last cell",
    "entries of the map of cells",
    "holder of a cell",
    "first place of a subspace in the list of polygons",
    "polygon in a subspace's list",
    "group in a subspace's list of polygons",
    "corner outside the unit cube, of polygon",
    "material of a polygon",
    "kind of a material",
    "first normal of a polygon",
    "level of a patch",
    "first patch reference or lit sides of a polygon",
    "depth of a tree, at node",
    "first child of a node",
    "leaf of a tree",
    "kept surface",
    "PE of a patch reference",
    "part of a patch reference",
    "patch of a part",
    "side that its polygon promises, missing at patch",
    "first facet of a patch",
    "polygon of a facet",
    "code of a facet",
    "element of a facet",
    "share of a facet not in 0 to 1, of polygon",
    "side of a patch",
    "first element of a patch's side",
    "sum of the hemi-cube's weights (low word, high word)",
    "refractive index not above 0",
    "lobe of a glossy material not in 0 to 1",
    "texels of a texture, or texture of a material",
    "size of a texture (width, height)",
    "first texture point of a polygon",
    "texture point too far away",
    "corner of an emitter outside the unit cube, of polygon",
    "chance of an emitter",
    "address of a block to load",
    "offset of a block to load into a store (and its bytes)",
    "number of shooters to select",
    "patch to shoot",
    "side of the patch to shoot",
    "kind of a shot",
    "flux to shoot that is not there, of channel",
    "deal of a shot's points",
    "tiles held at once",
    "column of a tile",
    "row of a tile",
};

/// FaultCode::bad_record: which field; its value follows.
enum class RecordField : std::uint32_t {
  kind,
  place,
  entry_axis,
  slot,
  part,
  side,
  flux,
  waiting,
  branch_place,
  surface,
  point_places,
  point_part,
  count
};
inline constexpr std::array<std::string_view, static_cast<std::size_t>(RecordField::count)> kRecordFieldNames = {
    "kind",
    "cell where it stands",
    "axis by which it entered its cell",
    "record slot",
    "part of a patch that it hits",
    "side of the patch that it hits",
    "flux, high word",
    "number of waiting branches",
    "cell of a waiting branch",
    "surface that it hits",
    "points waiting at this PE",
    "part of a point",
};

/// FaultCode::bad_layout: a StoreName, or one of the layout's other fields.
enum class LayoutField : std::uint32_t {
  stage = kStores,
  cells,
  own_slots,
  open_batches,
  credits_kept,
  bounces,
  hemicube_size,
  shot_points,
  emission_points,
  points_per_quantum,
  cell_size,
  pixel_scale,
  layers,
  view,
  count
};
inline constexpr std::array<std::string_view, static_cast<std::size_t>(LayoutField::count)> kLayoutFieldNames = {
    "cell words",     "cell entries", "subspaces",       "polygon list",       "polygons",     "materials",
    "normals",        "nodes",        "record slots",    "patch references",   "patch parts",  "patches",
    "patch sides",    "elements",     "facets",          "hemi-cube",          "lattice",      "kept surfaces",
    "textures",       "texels",       "texture points",  "sample places",      "filter",       "emitters",
    "stage",          "cells",        "own slots",       "open batches",       "credits kept", "bounces",
    "hemi-cube size", "shot points",  "emission points", "points per quantum", "cell size",    "pixel scale",
    "picture layers", "view",
};

/// "" for a number that is none of the list's.
template <std::size_t kCount>
constexpr std::string_view name_in(const std::array<std::string_view, kCount>& names, std::uint32_t number) {
  return number < kCount ? names[number] : std::string_view();
}
static_assert(!kStoreIndexNames.back().empty() && !kRecordFieldNames.back().empty() &&
              !kLayoutFieldNames.back().empty());

}  // namespace torolux::protocol
