// SPDX-License-Identifier: MIT
// Proves: the geometry of glTF files is read as docs/gltf.md says (kinds of primitives and numbers, nodes, instances,
// neighbouring files), and what cannot be read is refused with the part's name.
#include <set>

#include "host_tools/scene/vec.hpp"
#include "tests/support/gltf_writer.hpp"
#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using Json = nlohmann::json;

Texts texts(GltfWriter& file) {
  const std::string json = file.gltf();
  return {{"a.gltf", json}, {"a.bin", file.bytes()}};
}
Scene load(GltfWriter& file) {
  return load_texts(texts(file), "a.gltf");
}
std::string refused(GltfWriter& file) {
  return refusal(texts(file), "a.gltf");
}

Vec3d normal(const Scene& scene, std::size_t t) {
  const auto& p = scene.triangles[t].position;
  return vec::cross(vec::subtract(scene.positions[p[1]], scene.positions[p[0]]),
                    vec::subtract(scene.positions[p[2]], scene.positions[p[0]]));
}

double whole_area(const Scene& scene) {
  double sum = 0;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) sum += area(scene, t);
  return sum;
}

TEST(Gltf, ASquareIsTheSameWithNeighbourAsGlbAndWithDataWithin) {
  GltfWriter file = gltf_square();
  const Scene with_neighbour = load(file);
  EXPECT_EQ(with_neighbour.triangles.size(), 2U);
  EXPECT_NEAR(whole_area(with_neighbour), 1, 1e-7);
  EXPECT_GT(normal(with_neighbour, 0)[2], 0);
  EXPECT_EQ(with_neighbour.materials[0].name, "m");
  const Scene glb = load_texts({{"a.glb", file.glb()}}, "a.glb");
  EXPECT_EQ(glb.positions, with_neighbour.positions);

  GltfWriter small;
  const std::size_t positions = small.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  small.mesh({{"attributes", {{"POSITION", positions}}}});
  small.gltf();
  // Three vertices: 0 0 0, 1 0 0, 0 1 0.
  small.json["buffers"][0]["uri"] =
      "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
  EXPECT_NEAR(whole_area(load_texts({{"a.gltf", small.json.dump()}}, "a.gltf")), 0.5, 1e-7);
}

// What validators refuse, and can be read in one way, is told with its place.
TEST(Gltf, BuffersAndViewsThatAreNotAsTheFormatWantsThemAreToldOrRefused) {
  GltfWriter file = gltf_square();
  Texts all = texts(file);
  const std::string length = std::to_string(file.bytes().size());
  file.json["buffers"][0]["byteLength"] = file.bytes().size() + 4;
  all["a.gltf"] = file.json.dump();
  EXPECT_THAT(load_texts(all, "a.gltf").warnings,
              Contains("a.gltf: buffer 0: a buffer has fewer bytes than its 'byteLength'; what reaches beyond them is "
                       "refused: " +
                       length + " of " + std::to_string(file.bytes().size() + 4)));
  file.json["buffers"][0].erase("byteLength");
  all["a.gltf"] = file.json.dump();
  EXPECT_THAT(load_texts(all, "a.gltf").warnings,
              Contains(HasSubstr("a.gltf: buffer 0: a buffer has no 'byteLength'")));

  file.json["buffers"][0]["uri"] = "https://example.org/a.bin";
  all["a.gltf"] = file.json.dump();
  EXPECT_THAT(refusal(all, "a.gltf"), StartsWith("a.gltf: buffer 0: lies at 'https://example.org/a.bin': nothing is"));

  const auto with_stride = [](int stride) {
    GltfWriter strided;
    const std::size_t positions = strided.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    strided.json["bufferViews"][0]["byteStride"] = stride;
    strided.mesh({{"attributes", {{"POSITION", positions}}}});
    return strided;
  };
  GltfWriter right = with_stride(12);
  EXPECT_THAT(load(right).warnings, Not(Contains(HasSubstr("byteStride"))));
  GltfWriter zero = with_stride(0);
  EXPECT_THAT(load(zero).warnings,
              Contains(HasSubstr("a.gltf: bufferView 0: a 'byteStride' that glTF does not allow")));
  GltfWriter small = with_stride(8);
  EXPECT_THAT(refused(small), StartsWith("a.gltf: accessor 0: its elements have 12 bytes each, and the 'byteStride' of "
                                         "its bufferView is 8"));
}

TEST(Gltf, ANodeWithAMatrixAndOtherPlacingIsToldOrRefused) {
  GltfWriter file = gltf_square();
  file.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1};
  file.json["nodes"][0]["translation"] = {0, 0, 5};
  const Scene scene = load(file);
  EXPECT_EQ(scene.positions[0][2], 5);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("a.gltf: node 0: a node has a 'matrix' and")));
  file.json["nodes"][0]["translation"] = {0, 0, 4};
  EXPECT_THAT(refused(file), StartsWith("a.gltf: node 0: has a 'matrix', and 'translation'"));
}

TEST(Gltf, StripsAndFansKeepTheirWinding) {
  for (const auto& [mode, corners] : {std::pair(5, std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}),
                                      std::pair(6, std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})}) {
    GltfWriter file;
    file.mesh({{"attributes", {{"POSITION", file.floats(corners, "VEC3")}}}, {"mode", mode}});
    const Scene scene = load(file);
    ASSERT_EQ(scene.triangles.size(), 2U) << mode;
    EXPECT_NEAR(whole_area(scene), 1, 1e-7) << mode;
    for (std::size_t t = 0; t < 2; ++t) EXPECT_GT(normal(scene, t)[2], 0) << mode;
  }
}

TEST(Gltf, PointsAndLinesAreTold) {
  GltfWriter file = gltf_square();
  Json line = file.json["meshes"][0]["primitives"][0];
  line["mode"] = 1;
  file.json["meshes"][0]["primitives"].push_back(line);
  const Scene scene = load(file);
  EXPECT_EQ(scene.triangles.size(), 2U);
  EXPECT_THAT(scene.warnings, Contains("a.gltf: mesh 0, primitive 1: points and lines are not rendered"));
}

TEST(Gltf, QuantizedAndSparsePositionsAreRead) {
  GltfWriter bytes;
  const std::size_t small = bytes.accessor<std::int8_t>({0, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0, 0}, "VEC3", 5120);
  // Each position takes four bytes: three and one that is passed over.
  bytes.json["accessors"][small]["count"] = 3;
  bytes.json["accessors"][small]["normalized"] = true;
  bytes.json["bufferViews"][0]["byteStride"] = 4;
  bytes.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  bytes.mesh({{"attributes", {{"POSITION", small}}}});
  EXPECT_NEAR(whole_area(load(bytes)), 0.5, 1e-7);

  GltfWriter sparse;
  const std::size_t positions = sparse.floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const std::uint16_t index = 1;
  const std::array<float, 3> value{3, 0, 0};
  sparse.json["accessors"][positions]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", sparse.view({reinterpret_cast<const char*>(&index), 2})}, {"componentType", 5123}}},
      {"values", {{"bufferView", sparse.view({reinterpret_cast<const char*>(value.data()), 12})}}}};
  sparse.mesh({{"attributes", {{"POSITION", positions}}}});
  EXPECT_NEAR(whole_area(load(sparse)), 1.5, 1e-7);
}

TEST(Gltf, NodesPlaceTheirMeshesAndMirroredOnesKeepTheirFronts) {
  GltfWriter file = gltf_square();
  file.json["nodes"][0]["scale"] = {-2, 1, 1};
  file.json["nodes"][0]["translation"] = {0, 0, 5};
  const double half = std::sqrt(0.5);
  file.json["nodes"].push_back({{"children", {0}}, {"rotation", {0, half, 0, half}}});  // 90 degrees about y
  file.json["scenes"][0]["nodes"] = {1};
  const Scene scene = load(file);
  EXPECT_NEAR(whole_area(scene), 2, 1e-6);
  vec::Box box;
  for (const Vec3d& p : scene.positions) box.include(p);
  EXPECT_NEAR(box.low[0], 5, 1e-6);  // z went to x, x to -z
  EXPECT_NEAR(box.high[2], 2, 1e-6);
  for (std::size_t t = 0; t < 2; ++t) EXPECT_GT(normal(scene, t)[0], 0);

  GltfWriter matrix = gltf_square();
  matrix.json["nodes"][0]["matrix"] = {0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 7, 0, 0, 1};
  for (const Vec3d& p : load(matrix).positions) EXPECT_NEAR(p[0], 7, 1e-12);
}

TEST(Gltf, AMeshStandsWhereverNodesAndInstancesPutIt) {
  GltfWriter file = gltf_square();
  file.node({{"mesh", 0}, {"translation", {0, 0, 3}}});
  const std::size_t shifts = file.floats({0, 0, 10, 0, 0, 20}, "VEC3");
  file.node({{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", shifts}}}}}}}});
  const Scene scene = load(file);
  EXPECT_EQ(scene.triangles.size(), 8U);
  std::set<double> heights;
  for (const Vec3d& p : scene.positions) heights.insert(p[2]);
  EXPECT_EQ(heights, (std::set<double>{0, 3, 10, 20}));
}

TEST(Gltf, TheDefaultSceneIsRead) {
  GltfWriter file = gltf_square();
  file.json["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 3}}});
  file.json["scenes"].push_back({{"nodes", {1}}});
  file.json["scene"] = 1;
  const Scene scene = load(file);
  for (const Vec3d& p : scene.positions) EXPECT_EQ(p[2], 3);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("scenes that are not the default")));
}

TEST(Gltf, StandsInASceneBesideAnObj) {
  GltfWriter file = gltf_square();
  Texts all = texts(file);
  all["b.obj"] = kTriangle;
  all["s.toml"] = "[[mesh]]\nfile = 'a.gltf'\ntranslate = [0, 0, 9]\n[[mesh]]\nfile = 'b.obj'\n";
  EXPECT_EQ(load_texts(all, "s.toml").triangles.size(), 3U);
}

TEST(Gltf, WhatCannotBeReadIsRefusedByName) {
  const auto changed = [](std::string_view path, const Json& value) {
    GltfWriter file = gltf_square();
    file.gltf();
    file.json[Json::json_pointer(std::string(path))] = value;
    return refusal({{"a.gltf", file.json.dump()}, {"a.bin", file.bytes()}}, "a.gltf");
  };
  EXPECT_THAT(changed("/accessors/0/count", 5), StartsWith("a.gltf: accessor 0: its 5 elements reach beyond"));
  EXPECT_THAT(changed("/accessors/0/count", 4'000'000'000U), HasSubstr("'count' is 4000000000; at most 12000000"));
  EXPECT_THAT(changed("/accessors/0/byteOffset", 1000), HasSubstr("'byteOffset' is 1000; there are 48 bytes"));
  EXPECT_THAT(changed("/bufferViews/0/byteLength", 4000), HasSubstr("bufferView 0: reaches beyond its buffer"));
  EXPECT_THAT(changed("/accessors/0/componentType", 5130), HasSubstr("'componentType' is 5130"));
  EXPECT_THAT(changed("/accessors/3/count", 7), HasSubstr("accessor 3: its 7 elements"));
  EXPECT_THAT(changed("/meshes/0/primitives/0/indices", 9), StartsWith("a.gltf: mesh 0, primitive 0: 'indices' is 9"));
  EXPECT_THAT(changed("/nodes/0/children", {0}), StartsWith("a.gltf: node 0: is below itself"));
  EXPECT_THAT(changed("/nodes/0/mesh", "x"), HasSubstr("node 0: 'mesh' is not a whole number"));
  EXPECT_THAT(changed("/nodes/0/scale", {1, 1}), HasSubstr("node 0: 'scale' is not 3 numbers"));
  EXPECT_THAT(changed("/buffers/0/uri", "b.bin"), HasSubstr("buffer 0: there is no file 'b.bin'"));
  EXPECT_THAT(changed("/asset/version", "1.0"), HasSubstr("gltf-pipeline -i IN -o OUT"));
  EXPECT_THAT(changed("/extensionsRequired", {"KHR_draco_mesh_compression"}), HasSubstr("gltf-transform copy IN OUT"));
  EXPECT_THAT(changed("/extensionsRequired", {"KHR_texture_basisu"}), HasSubstr("gltf-transform ktxdecompress IN OUT"));
  EXPECT_THAT(changed("/extensionsRequired", {"ACME_moon"}), HasSubstr("requires the extension 'ACME_moon'"));
}

TEST(Gltf, DamagedFilesAreRefused) {
  GltfWriter file = gltf_square();
  const std::string glb = file.glb();
  const auto read = [](const std::string& bytes) { return refusal({{"a.glb", bytes}}, "a.glb"); };
  EXPECT_THAT(read(glb.substr(0, 10)), StartsWith("a.glb: is not a whole .glb"));
  EXPECT_THAT(read(glb.substr(0, glb.size() - 4)), StartsWith("a.glb: is not a whole .glb"));
  EXPECT_THAT(read("{\"asset\": "), StartsWith("a.glb: its JSON cannot be read"));
  EXPECT_THAT(read(""), StartsWith("a.glb: its JSON cannot be read"));
  EXPECT_THAT(read("{\"extras\": " + std::string(100'000, '[')), HasSubstr("brackets within each other"));
  for (std::size_t end = 0; end < glb.size(); end += 7) EXPECT_NE(read(glb.substr(0, end)), "(accepted)") << end;
}

TEST(Gltf, PositionsThatAreUsedMustBeFinite) {
  GltfWriter file;
  const float infinite = HUGE_VALF;
  const std::size_t positions = file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, infinite, 0, 0}, "VEC3");
  const std::size_t indices = file.accessor<std::uint8_t>({0, 1, 2}, "SCALAR", 5121);
  file.mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  EXPECT_EQ(load(file).triangles.size(), 1U);  // nothing uses the fourth
  file.json["meshes"][0]["primitives"][0].erase("indices");
  file.json["meshes"][0]["primitives"][0]["mode"] = 5;
  EXPECT_THAT(refused(file), StartsWith("a.gltf: mesh 0, primitive 0: the position of vertex 3 is not finite"));
}

}  // namespace
}  // namespace torolux
