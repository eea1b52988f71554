// SPDX-License-Identifier: MIT
// Radiance = emission + reflectance * flux / area / pi, of what is seen through mirrors and glass as well.
#include "host_tools/inspect/element_view.hpp"

#include <numbers>

namespace torolux {

Vec3d emitted_radiance(const Scene& scene, const MeshPatch& patch, std::uint32_t side, const LightUnits& units) {
  return emission_of(scene, scene.materials[patch.material], side, units.two_sided_lights);
}

Vec3d reflectance_of(const MeshPatch& patch) {
  Vec3d reflectance{};
  for (std::size_t c = 0; c < 3; ++c) reflectance[c] = patch.reflectance[c] * 0x1p-32;
  return reflectance;
}

Vec3d watts_of(const protocol::Flux& flux, const LightUnits& units) {
  Vec3d watts{};
  for (std::size_t c = 0; c < 3; ++c) watts[c] = static_cast<double>(flux[c]) * units.watts_per_quantum;
  return watts;
}

ElementView::ElementView(const Scene& scene, const Mesh& mesh, const Placement& placement, const LightUnits& units,
                         const CameraRays& rays)
    : scene_(scene), mesh_(mesh), units_(units), width_(rays.view().width), height_(rays.view().height) {
  SurfaceRays surfaces(scene, mesh, placement);
  const std::uint32_t pixels = width_ * height_;
  sights_.reserve(pixels);
  std::vector<double> areas(mesh.elements, 0);  // of an element seen before
  for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
    const Sight& sight = sights_.emplace_back(surfaces.along(rays.ray(pixel, 0)));
    area_.push_back(0);
    if (!sight.element || !sight.element->element) continue;
    const MeshPatch& patch = mesh.patches[sight.element->patch];
    double& area = areas[*sight.element->element];
    if (area == 0) area = mesh.element_area(patch, *sight.element->element - patch.first_element[sight.element->side]);
    area_.back() = area;
  }
}

std::array<float, 3> ElementView::radiance(const Sight& sight, std::span<const protocol::Flux> flux) const {
  std::array<float, 3> colour{};
  if (!sight.element) return colour;
  const MeshPatch& patch = mesh_.patches[sight.element->patch];
  const Vec3d emitted = emitted_radiance(scene_, patch, sight.element->side, units_);
  const Vec3d reflectance = reflectance_of(patch);
  const double area = area_[static_cast<std::size_t>(&sight - sights_.data())];
  const Vec3d watts = area > 0 ? watts_of(flux[*sight.element->element], units_) : Vec3d{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double reflected = area > 0 ? reflectance[c] * watts[c] / area / std::numbers::pi : 0;
    colour[c] = static_cast<float>(sight.weight[c] * (emitted[c] + reflected));
  }
  return colour;
}

Picture ElementView::picture(std::span<const protocol::Flux> flux) const {
  Picture picture{width_, height_, {}};
  picture.pixels.reserve(sights_.size());
  for (const Sight& sight : sights_) picture.pixels.push_back(radiance(sight, flux));
  return picture;
}

}  // namespace torolux
