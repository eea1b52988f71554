// SPDX-License-Identifier: MIT
// The scene as its elements see it: for each pixel the element there, found once for a camera; elements' flux, as often
// as it is asked for, becomes a picture. No machine is needed.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "host_tools/inspect/surface_rays.hpp"
#include "host_tools/layout/light_units.hpp"
#include "host_tools/picture/picture.hpp"

namespace torolux {

class ElementView {
 public:
  /// A ray for each pixel: that of its first sample. All but the rays outlive this.
  ElementView(const Scene& scene, const Mesh& mesh, const Placement& placement, const LightUnits& units,
              const CameraRays& rays);

  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }
  /// By pixel, row 0 on top.
  std::span<const Sight> sights() const { return sights_; }
  /// What its surfaces emit, and reflect of the flux: each element evenly, a texture as its patch's mean, gloss not at
  /// all. flux: incident, by global element (Mesh::elements of them) [quanta].
  Picture picture(std::span<const protocol::Flux> flux) const;

 private:
  std::array<float, 3> radiance(const Sight& sight, std::span<const protocol::Flux> flux) const;

  const Scene& scene_;
  const Mesh& mesh_;
  const LightUnits& units_;
  std::uint32_t width_, height_;
  std::vector<Sight> sights_;
  std::vector<double> area_;  // by pixel, of the element [user units^2]; 0: there is none
};

/// Emitted radiance of a patch's side [W/(m^2 sr)].
Vec3d emitted_radiance(const Scene& scene, const MeshPatch& patch, std::uint32_t side, const LightUnits& units);
/// Diffuse reflectance.
Vec3d reflectance_of(const MeshPatch& patch);
Vec3d watts_of(const protocol::Flux& flux, const LightUnits& units);

}  // namespace torolux
