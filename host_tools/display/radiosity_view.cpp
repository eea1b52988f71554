// SPDX-License-Identifier: MIT
// A ray against all triangles, once; then a few words of memory for each pixel.
#include "host_tools/display/radiosity_view.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include "host_tools/layout/golden_step.hpp"
#include "host_tools/layout/stage_layout.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

using protocol::Vec3f;

/// Rays times triangles: about a second's work.
constexpr double kMostTests = 2e8;
/// Between looks at the clock.
constexpr double kTestsAtOnce = 1e5;

Vec3d minus(const Vec3f& a, const Vec3f& b) {
  return {double{a[0]} - double{b[0]}, double{a[1]} - double{b[1]}, double{a[2]} - double{b[2]}};
}

struct Hit {
  double distance, b1, b2;
  bool front;
};

/// T. Moeller and B. Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997.
std::optional<Hit> meets(const Vec3f& origin, const Vec3d& direction, const std::array<Vec3f, 3>& corner) {
  const Vec3d edge1 = minus(corner[1], corner[0]), edge2 = minus(corner[2], corner[0]);
  const Vec3d p = vec::cross(direction, edge2);
  const double determinant = vec::dot(edge1, p);
  if (determinant == 0) return std::nullopt;
  const Vec3d t = minus(origin, corner[0]);
  const double b1 = vec::dot(t, p) / determinant;
  if (!(b1 >= 0 && b1 <= 1)) return std::nullopt;
  const Vec3d q = vec::cross(t, edge1);
  const double b2 = vec::dot(direction, q) / determinant;
  const double distance = vec::dot(edge2, q) / determinant;
  if (!(b2 >= 0 && b1 + b2 <= 1 && distance > 0)) return std::nullopt;
  return Hit{distance, b1, b2, determinant > 0};
}

std::uint32_t step_for(std::uint32_t width, std::uint32_t height, std::size_t triangles) {
  const auto edge = std::max(width, height);
  std::uint32_t step = std::max(1U, (edge + RadiosityView::kMostEdge - 1) / RadiosityView::kMostEdge);
  const auto tests = [&] {
    const std::uint64_t rays = std::uint64_t{width / step} * (height / step);
    return static_cast<double>(rays) * static_cast<double>(triangles);
  };
  while (tests() > kMostTests && edge / (step + 1) >= RadiosityView::kLeastEdge) ++step;
  return step;
}

/// A PE may be writing it: each word as it is at some moment. Absent: it lies outside.
template <class Word>
std::optional<Word> word_at(std::span<const std::byte> memory, std::uint64_t address) {
  const std::uint64_t at = address - protocol::kLocalMemoryBase;
  if (at > memory.size() || memory.size() - at < sizeof(Word) || at % alignof(Word) != 0) return std::nullopt;
  return __atomic_load_n(reinterpret_cast<const Word*>(memory.data() + at), __ATOMIC_RELAXED);
}

}  // namespace

RadiosityView::RadiosityView(const RunningRender& running)
    : step_(step_for(running.program.job().ray_tracing.width, running.program.job().ray_tracing.height,
                     running.setup.mesh.triangles.size())),
      width_(std::max(1U, running.program.job().ray_tracing.width / step_)),
      height_(std::max(1U, running.program.job().ray_tracing.height / step_)),
      seen_(std::size_t{width_} * height_),
      patch_of_facet_(running.setup.mesh.facets.size()),
      homes_(running.setup.placement.torus.pes()) {
  const std::vector<MeshPatch>& patches = running.setup.mesh.patches;
  for (std::uint32_t i = 0; i < patches.size(); ++i)
    std::fill_n(patch_of_facet_.begin() + patches[i].first_facet, patches[i].facets, i);
}

void RadiosityView::work(const RunningRender& running, double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  const auto triangles = std::max<double>(1, static_cast<double>(running.setup.mesh.triangles.size()));
  const auto rays = static_cast<std::size_t>(std::max(1.0, kTestsAtOnce / triangles));
  const std::uint64_t far_off = golden_step(seen_.size());  // pixels are found all over the picture
  while (!whole() && std::chrono::steady_clock::now() < end) {
    for (std::size_t i = 0; i < rays && !whole(); ++i) {
      const std::size_t pixel = next_++ * far_off % seen_.size();
      seen_[pixel] = first_hit(running, pixel);
      if (seen_[pixel].any) home_of(running, running.setup.placement.patch_home[seen_[pixel].patch].pe);
    }
  }
}

RadiosityView::Seen RadiosityView::first_hit(const RunningRender& running, std::size_t pixel) const {
  const Mesh& mesh = running.setup.mesh;
  const RayTracingSettings& picture = running.program.job().ray_tracing;
  const std::size_t x = pixel % width_ * step_ + step_ / 2, y = pixel / width_ * step_ + step_ / 2;
  const std::size_t of_picture =
      std::min<std::size_t>(y, picture.height - 1) * picture.width + std::min<std::size_t>(x, picture.width - 1);
  const CameraRay ray = running.program.job().rays.ray(static_cast<std::uint32_t>(of_picture), 0);
  const Vec3d direction = {double{ray.direction[0]}, double{ray.direction[1]}, double{ray.direction[2]}};
  std::optional<Hit> nearest;
  std::uint32_t triangle = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto hit = meets(ray.origin, direction, mesh.triangles[t].corner);
    if (!hit || (nearest && hit->distance >= nearest->distance)) continue;
    nearest = hit;
    triangle = t;
  }
  if (!nearest || mesh.triangles[triangle].sides == 0) return {};
  const MeshFacet& facet =
      mesh.facets[mesh.facet_at(triangle, static_cast<float>(nearest->b1), static_cast<float>(nearest->b2))];
  const std::uint32_t patch = patch_of_facet_[static_cast<std::size_t>(&facet - mesh.facets.data())];
  const std::uint8_t side = nearest->front ? 0 : 1;
  return {patch, facet.element, side, mesh.patches[patch].side[side] != protocol::kNoSide};
}

const RadiosityView::Home& RadiosityView::home_of(const RunningRender& running, protocol::PeNumber pe) {
  if (homes_[pe]) return *homes_[pe];
  const RenderSetup& setup = running.setup;
  const protocol::StageLayout layout =
      lay_out(setup.mesh, setup.placement, pe, protocol::Stage::radiosity, setup.parameters, setup.map).layout;
  Home home{layout.patch_sides.address, layout.elements.address, {}};
  std::uint32_t sides = 0;
  for (const std::uint32_t number : setup.placement.patches_of_pe[pe]) {
    home.first_side.push_back(sides);
    for (const std::uint32_t side : setup.mesh.patches[number].side) sides += side != protocol::kNoSide ? 1 : 0;
  }
  return homes_[pe].emplace(std::move(home));
}

std::array<float, 3> RadiosityView::light_of(const RunningRender& running, const Seen& seen) const {
  const RenderSetup& setup = running.setup;
  const MeshPatch& patch = setup.mesh.patches[seen.patch];
  const PatchHome& owner = setup.placement.patch_home[seen.patch];
  const Home& home = *homes_[owner.pe];
  const std::span<const std::byte> memory = running.machine.local_memory(owner.pe);
  // The front side first, where there is one.
  const std::uint32_t before = seen.side == 1 && patch.side[0] != protocol::kNoSide ? 1 : 0;
  const std::uint64_t side =
      home.sides + std::uint64_t{home.first_side[owner.local] + before} * sizeof(protocol::PatchSide);
  const auto first = word_at<std::uint32_t>(memory, side + offsetof(protocol::PatchSide, first_element));
  if (!first) return {};
  const std::uint64_t element = home.elements + (std::uint64_t{*first} + seen.element) * sizeof(protocol::Element);
  const double watts = setup.units.watts_per_quantum / std::numbers::pi;
  const double area = setup.mesh.element_area(patch, seen.element);
  const protocol::Flux emission = patch_emission(running.program.job().scene, patch, seen.side, setup.units);
  std::array<float, 3> light{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto flux =
        word_at<std::int64_t>(memory, element + offsetof(protocol::Element, flux) + c * sizeof(std::int64_t));
    const double reflected = static_cast<double>(flux.value_or(0)) * patch.reflectance[c] * 0x1p-32 / area;
    light[c] = static_cast<float>(watts * (reflected + static_cast<double>(emission[c]) / patch.area));
  }
  return light;
}

Picture RadiosityView::picture(const RunningRender& running) const {
  Picture picture{width_, height_, std::vector<std::array<float, 3>>(seen_.size())};
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    if (seen_[i].any) picture.pixels[i] = light_of(running, seen_[i]);
  }
  return picture;
}

}  // namespace torolux
