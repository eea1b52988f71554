// SPDX-License-Identifier: MIT
// What a PE found wrong, in words: first details of the fault codes. Numbers and words of one list stand side by side,
// so that the host can say what a PE only numbers. In the words the first % stands for the second detail, the second %
// for the third. A fault is no part of a layout: new ones go to the end.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "firmware/protocol/store_names.hpp"

namespace torolux::protocol {

/// FaultCode::outside_store: which index.
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
  lit_sides,
  no_facets,
  texels,
  // What the host's messages ask for
  load_block,
  load_offset,
  select_count,
  shoot_patch,
  shoot_side,
  shoot_kind,
  shoot_amount,
  deal_parts,
  deal_pe,
  deal_point,
  tile_places,
  tile_columns,
  tile_rows,
  view_first,
  view_step,
  sky_entries,
  sky_chance,
  sky_opening,
  lamp,
  lamp_size,
  lamp_table,
  lamp_chance,
  count
};
inline constexpr std::array<std::string_view, static_cast<std::size_t>(StoreIndex::count)> kStoreIndexWords = {
    "map of cells: % cells in % words",
    "map of cells: % entries before a word instead of %",
    "map of cells: bits beyond the last cell, % (% cells)",
    "map of cells: % entries instead of %",
    "holder of a cell = %, limit %",
    "first place of a subspace in the list of polygons = %, with its count beyond the limit %",
    "polygon in a subspace's list = %, limit %",
    "head of a group in a subspace's list of polygons = %",
    "corner outside the unit cube, of polygon %",
    "material of a polygon = %, limit %",
    "kind of a material = %, at most %",
    "first normal of a polygon = %, limit %",
    "level of a patch = %, at most %",
    "first patch reference of a polygon = %, with its count beyond the limit %",
    "tree deeper than it may be, at node % (at most % levels)",
    "first child of a node = %, limit %",
    "leaf of a tree = %, limit %",
    "kept surface = %, limit %",
    "PE of a patch reference = %, limit %",
    "part of a patch reference = %, limit %",
    "patch of a part = %, limit %",
    "patch % has no side %, which its polygon promises",
    "first facet of a patch = %, with its count beyond the limit %",
    "polygon of a facet = %, limit %",
    "code of a facet = % (at most % levels)",
    "element of a facet = %, limit %",
    "share of a facet not above 0 and at most 1, of polygon %",
    "side of a patch = %, limit %",
    "first element of a patch's side = %, with its count beyond the limit %",
    "sum of the hemi-cube's weights not 1: low word %, high word %",
    "refractive index not above 0",
    "lobe of a glossy material not above 0 and at most 1",
    "texture of a material = %, limit %",
    "size of a texture = % x %",
    "first texture point of a polygon = %, limit %",
    "texture point too far away",
    "corner of an emitter outside the unit cube, of polygon %",
    "chance of an emitter = %, at least %",
    "lit sides of a polygon = %, at most %",
    "patch % has no facets",
    "first texel of a texture = %, with its size beyond the limit %",
    "block to load outside free memory, of no or too many bytes, or not in whole words: address %, % bytes",
    "block to load outside its store, too long, or not in whole words: offset %, % bytes",
    "shooters to select = %: at least 1 and at most %",
    "patch to shoot = %, limit %",
    "side of the patch to shoot = %, which it does not have",
    "kind of a shot = %, at most %",
    "flux to shoot that is not there, of channel %",
    "parts of dealt points = %: 1 or, at the beginning of a point, %",
    "PE that a point is dealt to = %, limit %",
    "points dealt after the shot's last: place % of the message; the shot has %",
    "tiles held at once = %, limit %",
    "tile empty or outside the picture: first column %, picture's width %",
    "tile empty or outside the picture: first row %, picture's height %",
    "pass over a picture without samples, or beyond a pixel's: first %, of %",
    "step between the samples of a pass = %, limit %",
    "entries of the sky = %: none or %",
    "chance of a part of the sky = %, at least %",
    "corner of an opening outside the unit cube, of opening %",
    "lamp of a material or an emitter = %, limit %",
    "table of a lamp: % bands by % sectors",
    "first entry of a lamp's table = %, with its size beyond the limit %",
    "chance of a part of a lamp = %, at least %",
};

/// FaultCode::bad_record: which field; no third detail.
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
  opening,
  point_lamp,
  count
};
inline constexpr std::array<std::string_view, static_cast<std::size_t>(RecordField::count)> kRecordFieldWords = {
    "kind = %",
    "cell where it stands = %",
    "axis by which it entered its cell: flags %",
    "record slot = %",
    "part of a patch that it hits = %",
    "side of the patch that it hits = %, which is not there",
    "flux: high word %",
    "number of waiting branches = %",
    "cell of a waiting branch = %",
    "surface that it hits = %",
    "points waiting at this PE = %",
    "part of a point = %",
    "opening through which sky comes = %, which is not there",
    "lamp of a point: flags %, which is not there or dark on that side",
};

/// FaultCode::bad_layout: a StoreName, with its address and count, or one of the layout's other fields.
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
  samples,
  filter_bits,
  picture_edge,
  count
};
inline constexpr std::array<std::string_view, static_cast<std::size_t>(LayoutField::count)> kLayoutFieldWords = {
    "cell words: address %, count %",
    "cell entries: address %, count %",
    "subspaces: address %, count %",
    "polygon list: address %, count %",
    "polygons: address %, count %",
    "materials: address %, count %",
    "normals: address %, count %",
    "nodes: address %, count %",
    "record slots: address %, count %",
    "patch references: address %, count %",
    "patch parts: address %, count %",
    "patches: address %, count %",
    "patch sides: address %, count %",
    "elements: address %, count %",
    "facets: address %, count %",
    "hemi-cube: address %, count %",
    "irradiance: address %, count %",
    "kept surfaces: address %, count %",
    "textures: address %, count %",
    "texels: address %, count %",
    "texture points: address %, count %",
    "sample places: address %, count %",
    "filter: address %, count %",
    "emitters: address %, count %",
    "sky: address %, count %",
    "openings: address %, count %",
    "lamps: address %, count %",
    "values of lamps: address %, count %",
    "chances of lamps: address %, count %",
    "stage = %",
    "cells along an axis = %: at least 1 and at most %",
    "own record slots = %, of % in all",
    "open batches = %: a power of 2 and at most %",
    "credits kept = %: at least 1",
    "bounces = %: at least 1 and at most %",
    "size of a hemi-cube = %: even, at least 2 and at most %",
    "points of a shot = %: at least 1 and at most %",
    "points of an emitter's shot = %: at least 1 and at most %",
    "points for each quantum: bits %, of no finite number above 0",
    "size of a cell not finite and above 0, along axis %",
    "pixel scale not finite and above 0: bits %",
    "layers of the picture: bits %, of % layers",
    "samples of a pixel = %, of % sample places",
    "bits of the filter's places = %: at least 1 and at most %",
    "edge of the picture = %: at least 1 and at most %",
};

/// "" for a number that is none of the list's.
template <std::size_t kCount>
constexpr std::string_view words_in(const std::array<std::string_view, kCount>& words, std::uint32_t number) {
  return number < kCount ? words[number] : std::string_view();
}

template <std::size_t kCount>
constexpr bool well_formed(const std::array<std::string_view, kCount>& words) {
  for (const std::string_view text : words) {
    int details = 0;
    for (const char c : text) details += c == '%' ? 1 : 0;
    if (text.empty() || details > 2) return false;
  }
  return true;
}
static_assert(well_formed(kStoreIndexWords) && well_formed(kRecordFieldWords) && well_formed(kLayoutFieldWords));

}  // namespace torolux::protocol
