// SPDX-License-Identifier: MIT
// The stores of test scenes, laid out by hand for any number of PEs: independent of what the host tools do.
#pragma once

#include <cstdint>
#include <vector>

#include "firmware/pe/scene.hpp"
#include "firmware/protocol/stores.hpp"
#include "tests/unit/firmware/pe/test_scene.hpp"

namespace torolux::test {

/// The stores of one PE.
struct PeStores {
  protocol::StageLayout layout{};  ///< its stores' addresses are not set
  std::vector<protocol::CellWord> cell_words;
  std::vector<protocol::CellEntry> cell_entries;
  std::vector<protocol::Subspace> subspaces;
  std::vector<protocol::ListedPolygon> polygon_list;
  std::vector<protocol::Polygon> polygons;
  std::vector<protocol::Material> materials;
  std::vector<protocol::Vec3f> normals;
  std::vector<std::uint32_t> nodes;  ///< uniform trees
  std::vector<protocol::PatchReference> references;
  std::vector<protocol::PatchPart> parts;
  std::vector<protocol::Patch> patches;
  std::vector<protocol::PatchSide> sides;
  std::vector<protocol::Element> elements;
  std::vector<protocol::Facet> facets;
  std::vector<protocol::HemicubeEntry> hemicube;
  std::vector<protocol::CornerIrradiance> irradiance;  ///< all `irradiance_value`
  std::vector<protocol::KeptSurface> kept;
  std::vector<protocol::Texture> textures;  ///< none, as those that follow
  std::vector<protocol::Texel> texels;
  std::vector<protocol::TexturePoint> texture_points;
  std::vector<protocol::SamplePlace> sample_places;
  std::vector<float> filter;
  std::vector<protocol::Emitter> emitters;  ///< ray tracing stage
  std::vector<protocol::SkyEntry> sky;      ///< none, as the openings
  std::vector<protocol::SkyOpening> sky_openings;
  std::vector<protocol::Lamp> lamps;  ///< none, as their values and chances
  std::vector<float> lamp_values;
  std::vector<std::uint32_t> lamp_chances;

  /// Spans over these vectors, for handlers called directly.
  pe::Scene scene();
};

/// By PE. irradiance_value: irradiance / pi at every vertex.
std::vector<PeStores> build_stores(const TestScene& scene, protocol::Stage stage, float irradiance_value = 1);

/// Exact delta form factors, normalised (see stores.hpp).
std::vector<protocol::HemicubeEntry> hemicube_table(std::uint32_t n);

}  // namespace torolux::test
