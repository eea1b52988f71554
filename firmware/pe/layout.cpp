// SPDX-License-Identifier: MIT
// Checks a stage's layout before anything uses it: stores inside free memory, aligned, apart from each other; sizes and
// limits as the handlers expect. Faults name the store (its order below) or field, and its address and count.
#include <array>
#include <limits>

#include "firmware/pe/pe.hpp"

namespace torolux::pe {
namespace {

using protocol::Stage;
using protocol::StageLayout;
using protocol::Store;

/// First detail of FaultCode::bad_layout: the stores in their order in StageLayout, then its other fields.
enum class LayoutField : std::uint32_t {
  subspaces,
  polygon_list,
  polygons,
  materials,
  normals,
  nodes,
  record_slots,
  patch_references,
  patches,
  patch_sides,
  elements,
  facets,
  hemicube,
  lattice,
  textures,
  texels,
  texture_points,
  emitters,
  stage,
  cells,
  own_slots,
  bounces,
  hemicube_size,
  shot_points,
  emission_points,
  points_per_quantum,
  cell_size,
  pixel_scale,
  layers,
};

struct Extent {
  Store store;
  std::uint32_t element_bytes;
};
constexpr std::uint32_t kStores = 18;

std::array<Extent, kStores> extents(const StageLayout& l) {
  return {{
      {l.subspaces, sizeof(protocol::Subspace)},
      {l.polygon_list, sizeof(protocol::ListedPolygon)},
      {l.polygons, sizeof(protocol::Polygon)},
      {l.materials, sizeof(protocol::Material)},
      {l.normals, sizeof(protocol::Vec3f)},
      {l.nodes, sizeof(std::uint32_t)},
      {l.record_slots, protocol::slot_bytes(l.stage)},
      {l.patch_references, sizeof(protocol::PatchReference)},
      {l.patches, sizeof(protocol::Patch)},
      {l.patch_sides, sizeof(protocol::PatchSide)},
      {l.elements, sizeof(protocol::Element)},
      {l.facets, sizeof(protocol::Facet)},
      {l.hemicube, sizeof(protocol::HemicubeEntry)},
      {l.lattice, sizeof(protocol::LatticeTriangle)},
      {l.textures, sizeof(protocol::Texture)},
      {l.texels, sizeof(protocol::Texel)},
      {l.texture_points, sizeof(protocol::TexturePoint)},
      {l.emitters, sizeof(protocol::Emitter)},
  }};
}

void require(Niu& niu, bool holds, LayoutField field, std::uint32_t value, std::uint32_t count = 0) {
  if (!holds) niu.fail(FaultCode::bad_layout, static_cast<std::uint32_t>(field), value, count);
}

std::uint64_t end_of(const Extent& extent) {
  return extent.store.address + std::uint64_t{extent.store.count} * extent.element_bytes;
}

void check_stores(Niu& niu, const std::array<Extent, kStores>& all) {
  for (std::uint32_t i = 0; i < kStores; ++i) {
    const Store& store = all[i].store;
    if (store.count == 0) continue;
    const bool inside =
        store.address % 8U == 0 && store.address >= niu.memory().stores_begin() && end_of(all[i]) <= niu.memory_end();
    require(niu, inside, LayoutField{i}, store.address, store.count);
    for (std::uint32_t j = 0; j < i; ++j) {
      if (all[j].store.count == 0) continue;
      const bool apart = store.address >= end_of(all[j]) || all[j].store.address >= end_of(all[i]);
      require(niu, apart, LayoutField{i}, store.address, store.count);
    }
  }
}

bool finite_positive(float value) {
  return bits(value) > 0 && bits(value) < bits(std::numeric_limits<float>::infinity());
}

void check_radiosity(Niu& niu, const StageLayout& l) {
  const std::uint32_t n = l.hemicube_size;
  require(niu, n >= 2 && n % 2U == 0 && n <= protocol::kMostHemicubeSize, LayoutField::hemicube_size, n);
  require(niu, l.hemicube.count == protocol::hemicube_weights(n), LayoutField::hemicube, l.hemicube.address,
          l.hemicube.count);
  const auto from_1 = [](std::uint32_t k, std::uint32_t most) { return k >= 1 && k <= most; };
  require(niu, from_1(l.shot_points, protocol::kMostShotPoints), LayoutField::shot_points, l.shot_points);
  require(niu, from_1(l.emission_points, protocol::kMostEmissionPoints), LayoutField::emission_points,
          l.emission_points);
  require(niu, finite_positive(l.points_per_quantum), LayoutField::points_per_quantum,
          static_cast<std::uint32_t>(bits(l.points_per_quantum)));
}

}  // namespace

void check_layout(Niu& niu, const StageLayout& l) {
  const bool known = l.stage == Stage::radiosity || l.stage == Stage::ray_tracing;
  require(niu, known, LayoutField::stage, static_cast<std::uint32_t>(l.stage));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    require(niu, l.cells[axis] >= 1 && l.cells[axis] <= 0xFFFFU, LayoutField::cells, l.cells[axis]);
    require(niu, finite_positive(l.cell_size[axis]), LayoutField::cell_size, static_cast<std::uint32_t>(axis));
  }
  check_stores(niu, extents(l));
  const std::uint32_t slots = l.record_slots.count;
  require(niu, l.own_slots >= protocol::own_slots(l.stage) && l.own_slots < slots && slots <= 0xFFFFU,
          LayoutField::own_slots, l.own_slots, slots);
  require(niu, l.bounces >= 1 && l.bounces <= protocol::kMostBounces, LayoutField::bounces, l.bounces);
  if (l.stage == Stage::radiosity) {
    check_radiosity(niu, l);
  } else {
    require(niu, finite_positive(l.pixel_scale), LayoutField::pixel_scale, 0);
    require(niu, l.layers >> protocol::kPlanes == 0, LayoutField::layers, l.layers);
  }
}

}  // namespace torolux::pe
