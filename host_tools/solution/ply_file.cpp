// SPDX-License-Identifier: MIT
// Facet by facet and side by side: three vertices of their own, in the user's units, with reflected and emitted light
// together.
#include "host_tools/solution/ply_file.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>

#include "emulator/errors.hpp"
#include "firmware/protocol/element_light.hpp"
#include "host_tools/files/extension.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian, written as it lies in memory");

class PlyWriter {
 public:
  PlyWriter(const Scene& scene, const Mesh& mesh, const LightUnits& units, const VertexIrradiance& irradiance)
      : scene_(scene), mesh_(mesh), units_(units), irradiance_(irradiance) {}

  std::vector<std::byte> write() {
    const std::size_t faces = irradiance_.triangles.size();
    put_text("ply\nformat binary_little_endian 1.0\ncomment radiosity B [W/m^2] as red, green, blue\nelement vertex " +
             std::to_string(3 * faces) +
             "\nproperty float x\nproperty float y\nproperty float z\nproperty float red\nproperty float green\n"
             "property float blue\nproperty uint element\nelement face " +
             std::to_string(faces) + "\nproperty list uchar uint vertex_indices\nend_header\n");
    for (const MeshPatch& patch : mesh_.patches) {
      for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) put_facet(patch, f);
    }
    for (std::uint32_t face = 0; face < faces; ++face) {
      put(std::uint8_t{3});
      for (std::uint32_t corner = 0; corner < 3; ++corner) put(3 * face + corner);
    }
    return std::move(bytes_);
  }

 private:
  template <typename T>
  void put(const T& value) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(bytes_.data() + at, &value, sizeof value);
  }
  void put_text(const std::string& text) {
    for (const char c : text) put(c);
  }

  void put_facet(const MeshPatch& patch, std::uint32_t f) {
    const MeshFacet& facet = mesh_.facets[f];
    const auto corners = grid_corners(mesh_.triangles[facet.triangle], facet.code);
    const protocol::CornerIrradiance* light = &irradiance_.triangles[irradiance_.first[f]];
    for (std::uint32_t side = 0; side < 2; ++side) {
      if (patch.side[side] == protocol::kNoSide) continue;
      for (const std::size_t c :
           side == 0 ? std::array<std::size_t, 3>{0, 1, 2} : std::array<std::size_t, 3>{2, 1, 0}) {
        for (const double along : mesh_.space.to_user(corners[c])) put(static_cast<float>(along));
        for (std::size_t k = 0; k < 3; ++k) put(radiosity(patch, side, protocol::irradiance_at(*light, c)[k], k));
        put(patch.first_element[side] + facet.element);
      }
      ++light;
    }
  }

  float radiosity(const MeshPatch& patch, std::uint32_t side, float irradiance_over_pi, std::size_t channel) const {
    const double reflected = std::ldexp(patch.reflectance[channel], -32) * static_cast<double>(irradiance_over_pi);
    const SceneMaterial& material = scene_.materials[patch.material];
    const double emitted = emission_of(scene_, material, side, units_.two_sided_lights)[channel] / units_.unit_radiance;
    return static_cast<float>((reflected + emitted) * units_.unit_radiance * std::numbers::pi);
  }

  const Scene& scene_;
  const Mesh& mesh_;
  const LightUnits& units_;
  const VertexIrradiance& irradiance_;
  std::vector<std::byte> bytes_;
};

}  // namespace

std::vector<std::byte> pack_ply(const Scene& scene, const Mesh& mesh, const LightUnits& units,
                                const VertexIrradiance& irradiance) {
  return PlyWriter(scene, mesh, units, irradiance).write();
}

void check_ply_writable(const std::filesystem::path& file) {
  const std::string extension = small_extension(file);
  if (!extension.empty() && extension != ".ply")
    throw UsageError("--save-mesh: " + file.string() + ": the mesh is written as .ply, in no other format; call it " +
                     std::filesystem::path(file).replace_extension(".ply").string());
  check_file_writable(file);
}

void save_ply(const std::filesystem::path& file, const Scene& scene, const Mesh& mesh, const LightUnits& units,
              const VertexIrradiance& irradiance) {
  write_file(file, pack_ply(scene, mesh, units, irradiance));
}

}  // namespace torolux
