// SPDX-License-Identifier: MIT
// Reads the attributes of primitives, and joins vertices to triangles.
#include "host_tools/scene/gltf_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host_tools/scene/imported_mesh.hpp"
#include "host_tools/scene/statements.hpp"

namespace torolux {
namespace {

enum class Mode : std::uint8_t { points, lines, line_loop, line_strip, triangles, strip, fan };

/// Corner c of triangle t, as a number into the vertices or indices of the primitive (glTF 2.0, 3.7.2.1).
std::size_t corner(Mode mode, std::size_t t, std::size_t c) {
  if (mode == Mode::triangles) return 3 * t + c;
  if (mode == Mode::fan) return c == 2 ? 0 : t + 1 + c;
  // Every second triangle of a strip runs the other way.
  return c == 0 ? t : t + (t % 2 == 0 ? c : 3 - c);
}

class Reader {
 public:
  Reader(const GltfObject& primitive, std::size_t accessors, GltfData& data, Notices& notices)
      : primitive_(primitive), accessors_(accessors), data_(data), notices_(notices) {}

  GltfSurface read(const GltfMapping& mapping) {
    const auto mode = static_cast<Mode>(primitive_.integer("mode", 6).value_or(4));
    const auto attributes = primitive_.object("attributes");
    const auto positions = attributes ? attributes->index("POSITION", accessors_, "accessors") : std::nullopt;
    if (!positions) {
      notices_.note("a primitive without POSITION is left out", primitive_.place());
      return {};
    }
    if (mode < Mode::triangles) {
      notices_.note("points and lines are not rendered", primitive_.place());
      return {};
    }
    if (primitive_.has("targets"))
      notices_.note("morph targets are not used: it is rendered at rest", primitive_.place());
    surface_.positions = vectors(*positions);
    if (const auto normals = attributes->index("NORMAL", accessors_, "accessors")) surface_.normals = vectors(*normals);
    read_points(*attributes, mapping);
    if (attributes->has("COLOR_0")) notices_.note("colours of vertices are not used", primitive_.place());
    join(mode);
    return std::move(surface_);
  }

 private:
  std::vector<Vec3d> vectors(std::size_t accessor) {
    const GltfNumbers read = data_.numbers(accessor, std::array<std::size_t, 1>{3});
    std::vector<Vec3d> result;
    result.reserve(read.count);
    for (std::size_t i = 0; i < read.count; ++i) result.push_back({read.at(i, 0), read.at(i, 1), read.at(i, 2)});
    return result;
  }

  void read_points(const GltfObject& attributes, const GltfMapping& mapping) {
    const auto accessor =
        mapping.attribute.empty() ? std::nullopt : attributes.index(mapping.attribute, accessors_, "accessors");
    if (!accessor) return;
    const GltfNumbers read = data_.numbers(*accessor, std::array<std::size_t, 1>{2});
    surface_.texture_points.reserve(read.count);
    bool beyond = false;
    for (std::size_t i = 0; i < read.count; ++i) {
      surface_.texture_points.push_back(mapping.placed(read.at(i, 0), read.at(i, 1)));
      for (const double x : surface_.texture_points.back()) beyond |= !(x >= -1e-4 && x <= 1 + 1e-4);
    }
    if (beyond && mapping.odd_wrap)
      notices_.note("a texture that is mirrored, or goes on in one direction alone, repeats here", primitive_.place());
  }

  void join(Mode mode) {
    const auto accessor = primitive_.index("indices", accessors_, "accessors");
    std::vector<std::uint32_t> vertices;
    if (accessor) {
      vertices = data_.integers(*accessor, surface_.positions.size(), "vertices of " + primitive_.words());
    } else {
      vertices.resize(surface_.positions.size());
      std::iota(vertices.begin(), vertices.end(), std::uint32_t{0});
    }
    const std::size_t whole = mode == Mode::triangles ? vertices.size() / 3
                              : vertices.size() < 3   ? 0
                                                      : vertices.size() - 2;
    if (mode == Mode::triangles ? vertices.size() % 3 != 0 : whole == 0)
      notices_.note("corners that are not enough for a triangle are left out", primitive_.place());
    surface_.triangles.reserve(whole);
    for (std::size_t t = 0; t < whole; ++t) {
      const std::array triangle{vertices[corner(mode, t, 0)], vertices[corner(mode, t, 1)],
                                vertices[corner(mode, t, 2)]};
      // Strips are turned by triangles without area.
      if (mode != Mode::triangles &&
          (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]))
        continue;
      for (const std::uint32_t vertex : triangle) check(vertex);
      surface_.triangles.push_back(triangle);
    }
  }

  void check(std::uint32_t vertex) const {
    for (const double x : surface_.positions[vertex])
      if (!(std::abs(x) <= kMostCoordinate))
        refuse(primitive_.place(),
               "the position of vertex " + std::to_string(vertex) + " is not finite, or above 1e15 in magnitude");
  }

  const GltfObject& primitive_;
  std::size_t accessors_;
  GltfData& data_;
  Notices& notices_;
  GltfSurface surface_;
};

}  // namespace

GltfSurface read_gltf_surface(const GltfObject& primitive, std::size_t accessors, const GltfMapping& mapping,
                              GltfData& data, Notices& notices) {
  return Reader(primitive, accessors, data, notices).read(mapping);
}

}  // namespace torolux
