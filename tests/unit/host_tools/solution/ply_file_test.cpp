// SPDX-License-Identifier: MIT
// PLY export: as many vertices and faces as its head says, places in scene units, and the light of reflected and
// emitted radiosity.
#include "host_tools/solution/ply_file.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <numbers>
#include <string>

#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux {
namespace {

struct PlyVertex {
  float place[3], radiosity[3];
  std::uint32_t element;
};

TEST(PlyFile, HoldsAllFacetsWithTheirLight) {
  const Scene scene = test::room_with_box();
  const Mesh mesh = make_mesh(scene, {.patch_length = 0.5, .element_length = 0.25});
  const LightUnits units = light_units(scene, mesh, false);
  VertexIrradiance irradiance = make_vertex_irradiance(mesh, std::vector<protocol::Flux>(mesh.elements), 1, 1);
  for (auto& triangle : irradiance.triangles) triangle.irradiance_over_pi.fill({0.25F, 0.25F, 0.25F});
  const std::vector<std::byte> bytes = pack_ply(scene, mesh, units, irradiance);
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t faces = irradiance.triangles.size();
  EXPECT_NE(text.find("element vertex " + std::to_string(3 * faces) + "\n"), std::string::npos);
  EXPECT_NE(text.find("element face " + std::to_string(faces) + "\n"), std::string::npos);
  const std::size_t begin = text.find("end_header\n") + 11;
  ASSERT_EQ(bytes.size(), begin + 3 * faces * sizeof(PlyVertex) + faces * 13);
  std::vector<bool> is_front(mesh.elements, false);
  std::size_t expected = 0;
  for (const MeshPatch& patch : mesh.patches) {
    if (patch.first_element[0] == protocol::kNoSide) continue;
    for (std::uint32_t e = 0; e < patch.elements; ++e) is_front[patch.first_element[0] + e] = true;
    if (emits(scene.materials[patch.material])) expected += 3 * patch.facets;
  }
  std::size_t bright = 0;  // of fronts that emit, and only those
  for (std::size_t v = 0; v < 3 * faces; ++v) {
    PlyVertex vertex{};
    std::memcpy(&vertex, bytes.data() + begin + v * sizeof vertex, sizeof vertex);
    EXPECT_LT(vertex.element, mesh.elements);
    for (const float x : vertex.place) {
      EXPECT_GE(x, -1e-4F);
      EXPECT_LE(x, 1.0001F);
    }
    EXPECT_GE(vertex.radiosity[0], 0.0F);
    const bool front = vertex.element < mesh.elements && is_front[vertex.element];
    const bool shines = static_cast<double>(vertex.radiosity[0]) >= units.unit_radiance * std::numbers::pi * 0.99;
    bright += front && shines ? 1 : 0;
    EXPECT_TRUE(front || !shines) << "backs do not emit";
  }
  EXPECT_EQ(bright, expected);
}

}  // namespace
}  // namespace torolux
