// SPDX-License-Identifier: MIT
// Checks a stage's layout before anything uses it: stores inside free memory, aligned, apart from each other; sizes and
// limits as the handlers expect. Faults name the store or field, its value and limit.
#include <array>
#include <limits>

#include "firmware/pe/final_gather.hpp"
#include "firmware/protocol/fault_fields.hpp"
#include "firmware/protocol/store_names.hpp"

namespace torolux::pe {
namespace {

using protocol::Stage;
using protocol::StageLayout;
using protocol::Store;

using protocol::LayoutField;
using Extents = std::array<protocol::StoreExtent, protocol::kStores>;

void require(Niu& niu, bool holds, LayoutField field, std::uint32_t value, std::uint32_t limit = 0) {
  if (!holds) niu.fail(FaultCode::bad_layout, static_cast<std::uint32_t>(field), value, limit);
}

void require(Niu& niu, bool holds, protocol::StoreName store, std::uint32_t value, std::uint32_t count) {
  require(niu, holds, LayoutField{static_cast<std::uint32_t>(store)}, value, count);
}

void check_stores(Niu& niu, const Extents& all) {
  for (std::uint32_t i = 0; i < protocol::kStores; ++i) {
    const Store& store = all[i].store;
    if (store.count == 0) continue;
    const bool inside =
        store.address % 8U == 0 && store.address >= niu.memory().stores_begin() && all[i].end() <= niu.memory_end();
    require(niu, inside, LayoutField{i}, store.address, store.count);
    for (std::uint32_t j = 0; j < i; ++j) {
      if (all[j].store.count == 0) continue;
      const bool apart = store.address >= all[j].end() || all[j].store.address >= all[i].end();
      require(niu, apart, LayoutField{i}, store.address, store.count);
    }
  }
}

bool finite_positive(float value) {
  return bits(value) > 0 && bits(value) < bits(std::numeric_limits<float>::infinity());
}

void check_radiosity(Niu& niu, const StageLayout& l) {
  const std::uint32_t n = l.hemicube_size;
  require(niu, n >= 2 && n % 2U == 0 && n <= protocol::kMostHemicubeSize, LayoutField::hemicube_size, n,
          protocol::kMostHemicubeSize);
  require(niu, l.hemicube.count == protocol::hemicube_weights(n), protocol::StoreName::hemicube, l.hemicube.address,
          l.hemicube.count);
  const auto from_1 = [](std::uint32_t k, std::uint32_t most) { return k >= 1 && k <= most; };
  require(niu, from_1(l.shot_points, protocol::kMostShotPoints), LayoutField::shot_points, l.shot_points,
          protocol::kMostShotPoints);
  require(niu, from_1(l.emission_points, protocol::kMostEmissionPoints), LayoutField::emission_points,
          l.emission_points, protocol::kMostEmissionPoints);
  require(niu, finite_positive(l.points_per_quantum), LayoutField::points_per_quantum,
          static_cast<std::uint32_t>(bits(l.points_per_quantum)));
  const bool apart = l.apart == protocol::kDirect || l.apart == protocol::kTurned ||
                     l.apart == (std::uint32_t{protocol::kDirect} | protocol::kTurned);
  require(niu, apart, LayoutField::apart, l.apart);
  if (!gathers(l)) return;
  require(niu, finite_positive(l.dense_shot), LayoutField::dense_shot, static_cast<std::uint32_t>(bits(l.dense_shot)));
  require(niu, finite_positive(l.mean_radiosity), LayoutField::mean_radiosity,
          static_cast<std::uint32_t>(bits(l.mean_radiosity)));
}

/// What tells a sample's place in the picture, whoever makes its ray.
void check_picture(Niu& niu, const protocol::CameraView& view) {
  require(niu, view.samples >= 1 && view.samples <= protocol::kMostPixelSamples, LayoutField::samples, view.samples,
          protocol::kMostPixelSamples);
  for (const std::uint32_t edge : {view.width, view.height}) {
    require(niu, edge >= 1 && edge <= protocol::kMostPictureEdge, LayoutField::picture_edge, edge,
            protocol::kMostPictureEdge);
  }
}

}  // namespace

void check_view(Niu& niu, const StageLayout& l) {
  const protocol::CameraView& view = l.view;
  check_picture(niu, view);
  require(niu, view.samples == l.sample_places.count, LayoutField::samples, view.samples, l.sample_places.count);
  require(niu, view.filter_bits >= 1 && view.filter_bits <= protocol::kMostFilterBits, LayoutField::filter_bits,
          view.filter_bits, protocol::kMostFilterBits);
  require(niu, l.filter.count == (1U << view.filter_bits) + 1U, protocol::StoreName::filter, l.filter.address,
          l.filter.count);
}

void check_layout(Niu& niu, const StageLayout& l) {
  const bool known = l.stage == Stage::radiosity || l.stage == Stage::ray_tracing;
  require(niu, known, LayoutField::stage, static_cast<std::uint32_t>(l.stage));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    require(niu, l.cells[axis] >= 1 && l.cells[axis] <= protocol::kMostCellsPerAxis, LayoutField::cells, l.cells[axis],
            protocol::kMostCellsPerAxis);
    require(niu, finite_positive(l.cell_size[axis]), LayoutField::cell_size, static_cast<std::uint32_t>(axis));
  }
  check_stores(niu, protocol::store_extents(l));
  const std::uint32_t slots = l.record_slots.count;
  const bool power = l.open_batches != 0 && (l.open_batches & (l.open_batches - 1U)) == 0;
  require(niu, power && l.open_batches <= protocol::kMostOpenBatches, LayoutField::open_batches, l.open_batches,
          protocol::kMostOpenBatches);
  require(niu, l.own_slots == protocol::own_slots(l.stage, l.open_batches) && l.own_slots < slots && slots <= 0xFFFFU,
          LayoutField::own_slots, l.own_slots, slots);
  // With none it would send home what it has just asked for.
  require(niu, l.credits_kept >= 1, LayoutField::credits_kept, l.credits_kept);
  require(niu, l.bounces >= 1 && l.bounces <= protocol::kMostBounces, LayoutField::bounces, l.bounces,
          protocol::kMostBounces);
  if (l.stage == Stage::radiosity) {
    check_radiosity(niu, l);
  } else {
    require(niu, finite_positive(l.pixel_scale), LayoutField::pixel_scale,
            static_cast<std::uint32_t>(bits(l.pixel_scale)));
    require(niu, l.layers >> protocol::kPlanes == 0, LayoutField::layers, l.layers, protocol::kPlanes);
    check_picture(niu, l.view);
    if (l.sample_places.count > 0) check_view(niu, l);
  }
}

}  // namespace torolux::pe
