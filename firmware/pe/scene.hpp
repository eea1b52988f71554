// SPDX-License-Identifier: MIT
// The stores of a stage as spans: what a PE knows of the scene. Checked once (layout.cpp, verify.cpp), then trusted.
#pragma once

#include <cstdint>
#include <span>

#include "firmware/niu/memory.hpp"
#include "firmware/pe/cell_map.hpp"
#include "firmware/pe/hemicube.hpp"
#include "firmware/protocol/stores.hpp"

namespace torolux::pe {

struct Scene {
  protocol::StageLayout layout{};
  CellMap map;
  std::span<const protocol::Subspace> subspaces;
  std::span<const protocol::ListedPolygon> polygon_list;
  protocol::Vec3f box_scale{};  ///< parts of a subspace's edge (protocol/polygon_boxes.hpp) per unit of length
  std::span<const protocol::Polygon> polygons;
  std::span<const protocol::Material> materials;
  std::span<const protocol::Vec3f> normals;
  std::span<const std::uint32_t> nodes;
  std::span<const protocol::SkyEntry> sky;
  std::span<const protocol::Lamp> lamps;
  std::span<const float> lamp_values;
  // Radiosity stage.
  std::span<const protocol::PatchReference> patch_references;
  std::span<const protocol::PatchPart> patch_parts;
  std::span<const protocol::Patch> patches;
  std::span<protocol::PatchSide> patch_sides;
  std::span<protocol::Element> elements;
  std::span<const protocol::Facet> facets;
  std::span<const protocol::HemicubeEntry> hemicube;
  HemicubeGrid hemicube_grid;
  std::span<const protocol::SkyOpening> sky_openings;
  std::span<const std::uint32_t> lamp_chances;
  // Ray tracing stage.
  std::span<const protocol::CornerIrradiance> irradiance;
  std::span<const protocol::KeptSurface> kept;
  std::span<const protocol::Texture> textures;
  std::span<const protocol::Texel> texels;
  std::span<const protocol::TexturePoint> texture_points;
  std::span<const protocol::SamplePlace> sample_places;
  std::span<const float> filter;
  std::span<const protocol::Emitter> emitters;

  void set(const Memory& memory, const protocol::StageLayout& from) {
    layout = from;
    map = {memory.store<const protocol::CellWord>(layout.cell_words),
           memory.store<const protocol::CellEntry>(layout.cell_entries)};
    subspaces = memory.store<const protocol::Subspace>(layout.subspaces);
    polygon_list = memory.store<const protocol::ListedPolygon>(layout.polygon_list);
    polygons = memory.store<const protocol::Polygon>(layout.polygons);
    materials = memory.store<const protocol::Material>(layout.materials);
    normals = memory.store<const protocol::Vec3f>(layout.normals);
    nodes = memory.store<const std::uint32_t>(layout.nodes);
    sky = memory.store<const protocol::SkyEntry>(layout.sky);
    lamps = memory.store<const protocol::Lamp>(layout.lamps);
    lamp_values = memory.store<const float>(layout.lamp_values);
    patch_references = memory.store<const protocol::PatchReference>(layout.patch_references);
    patch_parts = memory.store<const protocol::PatchPart>(layout.patch_parts);
    patches = memory.store<const protocol::Patch>(layout.patches);
    patch_sides = memory.store<protocol::PatchSide>(layout.patch_sides);
    elements = memory.store<protocol::Element>(layout.elements);
    facets = memory.store<const protocol::Facet>(layout.facets);
    hemicube = memory.store<const protocol::HemicubeEntry>(layout.hemicube);
    sky_openings = memory.store<const protocol::SkyOpening>(layout.sky_openings);
    lamp_chances = memory.store<const std::uint32_t>(layout.lamp_chances);
    irradiance = memory.store<const protocol::CornerIrradiance>(layout.irradiance);
    kept = memory.store<const protocol::KeptSurface>(layout.kept);
    textures = memory.store<const protocol::Texture>(layout.textures);
    texels = memory.store<const protocol::Texel>(layout.texels);
    texture_points = memory.store<const protocol::TexturePoint>(layout.texture_points);
    sample_places = memory.store<const protocol::SamplePlace>(layout.sample_places);
    filter = memory.store<const float>(layout.filter);
    emitters = memory.store<const protocol::Emitter>(layout.emitters);
    prepare();
  }
  /// What follows from the layout.
  void prepare() {
    for (std::size_t a = 0; a < 3; ++a) box_scale[a] = float{protocol::kBoxParts} / layout.cell_size[a];
    if (layout.hemicube_size > 0) hemicube_grid = HemicubeGrid(layout.hemicube_size);
  }
};

}  // namespace torolux::pe
