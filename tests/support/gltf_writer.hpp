// SPDX-License-Identifier: MIT
// Meshes enter, as numbers; the bytes of a small .gltf or .glb leave.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace torolux {

class GltfWriter {
 public:
  nlohmann::json json = {{"asset", {{"version", "2.0"}}}};

  /// type: such as VEC3. Returns the accessor's number.
  template <class Component>
  std::size_t accessor(const std::vector<Component>& values, std::string_view type, int component_type) {
    const std::size_t components = type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
    json["accessors"].push_back(
        {{"bufferView", view({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Component)})},
         {"componentType", component_type},
         {"count", values.size() / components},
         {"type", type}});
    // glTF asks for the bounds of positions, and allows those of all.
    if (values.size() < components) return json["accessors"].size() - 1;
    std::vector<Component> least(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(components));
    std::vector<Component> most = least;
    for (std::size_t i = 0; i < values.size(); ++i) {
      least[i % components] = std::min(least[i % components], values[i]);
      most[i % components] = std::max(most[i % components], values[i]);
    }
    json["accessors"].back()["min"] = least;
    json["accessors"].back()["max"] = most;
    return json["accessors"].size() - 1;
  }
  std::size_t floats(const std::vector<float>& values, std::string_view type) { return accessor(values, type, 5126); }

  std::size_t view(std::string_view data) {
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", data.size()}});
    bytes_ += data;
    while (bytes_.size() % 4 != 0) bytes_.push_back('\0');
    return json["bufferViews"].size() - 1;
  }

  /// A mesh of one primitive, and a node that has it, in the only scene. Returns the node's number.
  std::size_t mesh(const nlohmann::json& primitive) {
    json["meshes"].push_back({{"primitives", {primitive}}});
    return node({{"mesh", json["meshes"].size() - 1}});
  }
  std::size_t node(const nlohmann::json& node) {
    json["nodes"].push_back(node);
    json["scenes"][0]["nodes"].push_back(json["nodes"].size() - 1);
    return json["nodes"].size() - 1;
  }

  /// The buffer lies in the file "a.bin".
  std::string gltf() {
    json["buffers"] = {{{"uri", "a.bin"}, {"byteLength", bytes_.size()}}};
    return json.dump();
  }
  const std::string& bytes() const { return bytes_; }

  std::string glb() {
    json["buffers"] = {{{"byteLength", bytes_.size()}}};
    std::string text = json.dump();
    while (text.size() % 4 != 0) text.push_back(' ');
    return "glTF" + word(2) + word(28 + text.size() + bytes_.size()) + word(text.size()) + "JSON" + text +
           word(bytes_.size()) + std::string("BIN\0", 4) + bytes_;
  }

 private:
  static std::string word(std::size_t value) {
    const auto small = static_cast<std::uint32_t>(value);
    std::string text(4, '\0');
    std::memcpy(text.data(), &small, 4);
    return text;
  }

  std::string bytes_;
};

/// A square from 0 to 1 in z = 0 as two triangles with indices, its front to +z, with normals and texture points.
inline GltfWriter gltf_square() {
  GltfWriter file;
  const std::size_t positions = file.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
  const std::size_t normals = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const std::size_t points = file.floats({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2");
  const std::size_t indices = file.accessor<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR", 5123);
  file.json["materials"] = {{{"name", "m"}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}}};
  file.mesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", points}}},
             {"indices", indices},
             {"material", 0}});
  return file;
}

}  // namespace torolux
