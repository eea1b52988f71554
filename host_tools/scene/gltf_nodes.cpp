// SPDX-License-Identifier: MIT
// Multiplies the transforms of nodes from the roots of a scene to its leaves.
#include "host_tools/scene/gltf_nodes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "host_tools/scene/imported_mesh.hpp"

namespace torolux {
namespace {

/// x, y, z, w; of any length but zero.
using Quaternion = std::array<double, 4>;

Affine placed(const Vec3d& translation, const Quaternion& rotation, const Vec3d& scale) {
  const double norm = std::inner_product(rotation.begin(), rotation.end(), rotation.begin(), 0.0);
  const double s = norm > 0 ? 2 / norm : 0;
  const auto [x, y, z, w] = rotation;
  Affine result;
  result.axes = {vec::scale({1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)}, scale[0]),
                 vec::scale({s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)}, scale[1]),
                 vec::scale({s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y)}, scale[2])};
  result.origin = translation;
  return result;
}

Vec3d triple(const std::optional<std::vector<double>>& read, double otherwise) {
  return read ? Vec3d{(*read)[0], (*read)[1], (*read)[2]} : Vec3d{otherwise, otherwise, otherwise};
}

Affine placed_by_parts(const GltfObject& node) {
  Quaternion rotation{0, 0, 0, 1};
  if (const auto read = node.numbers("rotation", 4)) std::ranges::copy(*read, rotation.begin());
  if (rotation == Quaternion{0, 0, 0, 0}) refuse(node.place(), "'rotation' is zero: no direction");
  return placed(triple(node.numbers("translation", 3), 0), rotation, triple(node.numbers("scale", 3), 1));
}

/// But for rounding.
bool place_alike(const Affine& a, const Affine& b) {
  const auto alike = [](const Vec3d& x, const Vec3d& y) {
    constexpr double rounding = 1e-5;
    return vec::length(vec::subtract(x, y)) <= rounding * std::max(vec::length(x), vec::length(y));
  };
  return alike(a.origin, b.origin) && std::ranges::equal(a.axes, b.axes, alike);
}

Affine local_place(const GltfObject& node, Notices& notices) {
  const auto m = node.numbers("matrix", 16);
  if (!m) return placed_by_parts(node);
  const auto column = [&m](std::size_t i) { return Vec3d{(*m)[4 * i], (*m)[4 * i + 1], (*m)[4 * i + 2]}; };
  if ((*m)[3] != 0 || (*m)[7] != 0 || (*m)[11] != 0 || (*m)[15] != 1)
    refuse(node.place(), "'matrix' does not end with the row 0 0 0 1: it is no placing of things");
  const Affine place{{column(0), column(1), column(2)}, column(3)};
  if (!node.has("translation") && !node.has("rotation") && !node.has("scale")) return place;
  if (!place_alike(place, placed_by_parts(node)))
    refuse(node.place(),
           "has a 'matrix', and 'translation', 'rotation' or 'scale' that place it differently; glTF allows one of "
           "both: take out what does not count");
  notices.note("a node has a 'matrix' and 'translation', 'rotation' or 'scale', which say the same", node.place());
  return place;
}

/// Where the scene begins.
std::vector<std::size_t> roots_of(const GltfObject& root, Notices& notices) {
  const std::size_t nodes = root.count("nodes");
  const std::size_t scenes = root.count("scenes");
  const auto chosen = root.index("scene", scenes, "scenes");
  if (scenes > 0) {
    if (!chosen && scenes > 1) notices.note("no scene is the default: the first one is read", root.place());
    if (chosen && scenes > 1) notices.note("scenes that are not the default are not read", root.place());
    return root.element("scenes", chosen.value_or(0), "scene").indices("nodes", nodes, "nodes");
  }
  if (nodes > 0) notices.note("there is no scene: all nodes are read", root.place());
  std::vector<bool> child(nodes, false);
  for (std::size_t i = 0; i < nodes; ++i)
    for (const std::size_t below : root.element("nodes", i, "node").indices("children", nodes, "nodes"))
      child[below] = true;
  std::vector<std::size_t> roots;
  for (std::size_t i = 0; i < nodes; ++i)
    if (!child[i]) roots.push_back(i);
  return roots;
}

}  // namespace

std::vector<PlacedNode> placed_nodes(const GltfDocument& document, Notices& notices) {
  const GltfObject root = document.root();
  const std::size_t nodes = root.count("nodes");
  std::vector<bool> seen(nodes, false);
  std::vector<PlacedNode> result;
  std::vector<PlacedNode> waiting;  // the next one last
  const auto wait = [&waiting](const std::vector<std::size_t>& numbers, const Affine& place) {
    for (auto number = numbers.rbegin(); number != numbers.rend(); ++number) waiting.push_back({*number, place});
  };
  wait(roots_of(root, notices), {});
  while (!waiting.empty()) {
    const auto [number, parent] = waiting.back();
    waiting.pop_back();
    const GltfObject node = root.element("nodes", number, "node");
    if (seen[number]) refuse(node.place(), "is below itself, or has two parents; the nodes of glTF form a tree");
    seen[number] = true;
    result.push_back({number, parent.after(local_place(node, notices))});
    wait(node.indices("children", nodes, "nodes"), result.back().place);
  }
  return result;
}

std::vector<Affine> instances(const GltfObject& node, const Affine& place, GltfData& data, std::size_t accessors) {
  const auto extension = node.extension("EXT_mesh_gpu_instancing");
  const auto attributes = extension ? extension->object("attributes") : std::nullopt;
  if (!attributes) return {place};
  const auto read = [&](std::string_view key, std::size_t components) {
    const auto accessor = attributes->index(key, accessors, "accessors");
    return accessor ? data.numbers(*accessor, std::array{components}) : GltfNumbers{};
  };
  const GltfNumbers translations = read("TRANSLATION", 3);
  const GltfNumbers rotations = read("ROTATION", 4);
  const GltfNumbers scales = read("SCALE", 3);
  const std::size_t count = std::max({translations.count, rotations.count, scales.count});
  for (const GltfNumbers* one : {&translations, &rotations, &scales})
    if (one->count != 0 && one->count != count)
      refuse(node.place(), "the attributes of its instances have different counts");
  if (count > kMostTriangles) refuse(node.place(), "has more than " + std::to_string(kMostTriangles) + " instances");
  std::vector<Affine> result;
  result.reserve(count);
  const auto vector = [](const GltfNumbers& from, std::size_t i, double otherwise) {
    return from.count == 0 ? Vec3d{otherwise, otherwise, otherwise}
                           : Vec3d{from.at(i, 0), from.at(i, 1), from.at(i, 2)};
  };
  for (std::size_t i = 0; i < count; ++i) {
    Quaternion rotation{0, 0, 0, 1};
    for (std::size_t c = 0; c < 4 && rotations.count > 0; ++c) rotation[c] = rotations.at(i, c);
    result.push_back(place.after(placed(vector(translations, i, 0), rotation, vector(scales, i, 1))));
  }
  return result;
}

}  // namespace torolux
