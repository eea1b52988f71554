// SPDX-License-Identifier: MIT
// Shots: a patch's flux becomes points, each on its way to the PE that makes its records. Enters: a shoot command, and
// who gets the points; leaves: point records.
#include <algorithm>

#include "firmware/pe/final_gather.hpp"
#include "firmware/pe/pe.hpp"
#include "firmware/pe/shot_points.hpp"
#include "firmware/protocol/fault_fields.hpp"
#include "firmware/protocol/flux.hpp"
#include "firmware/protocol/record_key.hpp"
#include "firmware/protocol/shot_grid.hpp"

namespace torolux::pe {
namespace {

using protocol::Flux;
using protocol::Patch;
using protocol::Shoot;
using protocol::ShotKind;

using protocol::StoreIndex;

/// limit: where the words of the index have one.
void require(Niu& niu, bool holds, StoreIndex index, std::uint32_t value, std::size_t limit = 0) {
  if (!holds) {
    niu.fail(FaultCode::outside_store, static_cast<std::uint32_t>(index), value, static_cast<std::uint32_t>(limit));
  }
}

/// Takes exactly `amount` out of the side's unshot flux and returns the flux to shoot.
Flux withdraw(Pe& pe, Niu& niu, const Shoot& shoot) {
  require(niu, shoot.patch < pe.scene.patches.size(), StoreIndex::shoot_patch, shoot.patch, pe.scene.patches.size());
  require(niu, shoot.side < 2, StoreIndex::shoot_side, shoot.side);
  const ShotKind last = gathers(pe.scene.layout) ? ShotKind::gathering : ShotKind::emitted;
  require(niu, shoot.kind <= last, StoreIndex::shoot_kind, static_cast<std::uint32_t>(shoot.kind),
          static_cast<std::uint32_t>(last));
  const Patch& patch = pe.scene.patches[shoot.patch];
  require(niu, patch.side[shoot.side] != protocol::kNoSide, StoreIndex::shoot_side, shoot.side);
  if (shoot.kind == ShotKind::gathering) return {};
  protocol::PatchSide& side = pe.scene.patch_sides[patch.side[shoot.side]];
  Flux flux{};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::int64_t there = shoot.kind == ShotKind::emitted ? side.emission[c] : side.incident[c] - side.shot[c];
    require(niu, shoot.amount[c] >= 0 && shoot.amount[c] <= there, StoreIndex::shoot_amount,
            static_cast<std::uint32_t>(c));
    if (shoot.kind == ShotKind::emitted) {
      side.emission[c] -= shoot.amount[c];
      flux[c] = shoot.amount[c];
    } else {
      side.shot[c] += shoot.amount[c];
      flux[c] = protocol::scale_down(shoot.amount[c], patch.reflectance[c]);
    }
  }
  return flux;
}

/// How noisy a side's light is by gathering rays against as many records: they differ by how much brighter it is than
/// what is around it. 0: no brighter; 1: by far.
float noise_of_rays(const Scene& scene, const Patch& patch, const protocol::PatchSide& side, float area) {
  float radiosity = 0.0F;
  for (std::size_t c = 0; c < 3; ++c)
    radiosity += static_cast<float>(protocol::scale_down(side.incident[c], patch.reflectance[c]));
  const float mean = scene.layout.mean_radiosity * area;
  if (!(radiosity > mean)) return 0.0F;
  const float brighter = 1.0F - mean / radiosity;
  return brighter * brighter;
}

/// Whether final gathering leaves the shot to its records; then what is withdrawn counts as kept apart.
bool keep_apart(const Scene& scene, const Shoot& shoot, std::uint32_t points) {
  if (shoot.kind != ShotKind::reflected || !gathers(scene.layout)) return false;
  const Patch& patch = scene.patches[shoot.patch];
  protocol::PatchSide& side = scene.patch_sides[patch.side[shoot.side]];
  float area = 0.0F;
  for (const protocol::Facet& facet : scene.facets.subspan(patch.first_facet, patch.facets)) area += facet.lit_area;
  const auto records = static_cast<float>(points * protocol::hemicube_pixels(scene.hemicube_grid.n));
  if (!(records * noise_of_rays(scene, patch, side, area) > scene.layout.dense_shot * area)) return false;
  for (std::size_t c = 0; c < 3; ++c) side.shot_apart[c] += static_cast<float>(shoot.amount[c]);
  return true;
}

/// To another PE at once: it may be waiting for work.
void send_point(Pe& pe, Niu& niu, PeNumber destination, const protocol::PointRecord& point) {
  if (destination == niu.pe()) {
    take_point(pe, niu, point);
    return;
  }
  const Slot slot = pe.slots.take(niu);
  pe.slots.at<protocol::PointRecord>(slot) = point;
  niu.send_records(destination, std::span(&slot, 1));
  pe.slots.free_own(slot);
}

}  // namespace

void begin_shot(Pe& pe, Niu& niu, const Shoot& shoot) {
  const PhaseMark<Phase::shoot> mark(niu);
  Shot& shot = pe.shot;
  shot.command = shoot;
  shot.flux = withdraw(pe, niu, shot.command);
  const protocol::StageLayout& layout = pe.scene.layout;
  if (shoot.kind == ShotKind::gathering) {
    const std::int64_t points = shoot.amount[0];
    require(niu, points >= 1 && points <= protocol::kMostGatherPoints, StoreIndex::gather_points,
            static_cast<std::uint32_t>(points), protocol::kMostGatherPoints);
    shot.points = static_cast<std::uint32_t>(points);
    begin_gathering(pe.scene, shoot);
  } else {
    shot.points = protocol::points_of_shot(shoot.kind, shot.flux, layout.points_per_quantum, layout.shot_points,
                                           layout.emission_points);
  }
  shot.apart = keep_apart(pe.scene, shoot, shot.points);
  shot.key = protocol::shot_key(pe.scene.layout.seed, pe.scene.patches[shot.command.patch].number, shot.command);
  shot.active = true;
  shot.point = 0;
  shot.part = 0;
  begin_points(pe.scene, shot);
}

void deal_points(Pe& pe, Niu& niu, const protocol::Deal& deal) {
  const PhaseMark<Phase::shoot> mark(niu);
  Shot& shot = pe.shot;
  require(niu, deal.parts == 1U || deal.parts == protocol::kPointParts, StoreIndex::deal_parts, deal.parts,
          protocol::kPointParts);
  for (std::uint32_t i = 0; i < deal.count; ++i) {
    require(niu, deal.pe[i] < niu.pes(), StoreIndex::deal_pe, deal.pe[i], niu.pes());
    if (shot.part == 0) {
      require(niu, shot.point < shot.points, StoreIndex::deal_point, i, shot.points);
      shot.divided = make_point(pe.scene, shot, niu.pe());
    }
    protocol::PointRecord point = shot.divided;
    if (deal.parts > 1U) {
      point.flags = static_cast<std::uint8_t>(point.flags | ((shot.part + 1U) << protocol::kPartShift));
      shot.part = (shot.part + 1U) % protocol::kPointParts;
    } else {
      require(niu, shot.part == 0, StoreIndex::deal_parts, deal.parts, protocol::kPointParts);
    }
    send_point(pe, niu, deal.pe[i], point);
  }
  shot.active = shot.point < shot.points || shot.part > 0;
}

}  // namespace torolux::pe
