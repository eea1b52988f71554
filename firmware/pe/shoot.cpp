// SPDX-License-Identifier: MIT
// Shots: a patch's flux becomes records, one for each hemi-cube pixel. Enters: a shoot command and credits; leaves:
// records, each of which is followed at once, and `shot_done`.
#include <algorithm>

#include "firmware/pe/hemicube.hpp"
#include "firmware/pe/pe.hpp"
#include "firmware/pe/shot_points.hpp"
#include "firmware/pe/surface.hpp"
#include "firmware/pe/walk.hpp"
#include "firmware/protocol/flux.hpp"
#include "firmware/protocol/random.hpp"
#include "firmware/protocol/stratified.hpp"

namespace torolux::pe {
namespace {

using protocol::Dimension;
using protocol::Flux;
using protocol::Patch;
using protocol::Shoot;
using protocol::ShotKind;

enum class ShootField : std::uint32_t { patch, side, kind, amount };

void require(Niu& niu, bool holds, ShootField field, std::uint32_t value) {
  if (!holds) niu.fail(FaultCode::outside_store, static_cast<std::uint32_t>(field), value);
}

/// Takes exactly `amount` out of the side's unshot flux and returns the flux to shoot.
Flux withdraw(Pe& pe, Niu& niu, const Shoot& shoot) {
  require(niu, shoot.patch < pe.scene.patches.size(), ShootField::patch, shoot.patch);
  require(niu, shoot.side < 2, ShootField::side, shoot.side);
  require(niu, shoot.kind <= ShotKind::emitted, ShootField::kind, static_cast<std::uint32_t>(shoot.kind));
  const Patch& patch = pe.scene.patches[shoot.patch];
  require(niu, patch.side[shoot.side] != protocol::kNoSide, ShootField::side, shoot.side);
  protocol::PatchSide& side = pe.scene.patch_sides[patch.side[shoot.side]];
  Flux flux{};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::int64_t there = shoot.kind == ShotKind::emitted ? side.emission[c] : side.incident[c] - side.shot[c];
    require(niu, shoot.amount[c] >= 0 && shoot.amount[c] <= there, ShootField::amount, static_cast<std::uint32_t>(c));
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

/// Points along one edge of the shot's grid. Little light leaves from few points, so that no record carries much less
/// than others: what it would add to the picture is not worth its way.
std::uint32_t grid_of(const protocol::StageLayout& layout, const Shot& shot) {
  if (shot.command.kind == ShotKind::emitted) return layout.emission_points;
  const std::int64_t most = std::max({shot.flux[0], shot.flux[1], shot.flux[2]});
  const float points = static_cast<float>(most) * layout.points_per_quantum;
  std::uint32_t grid = 1;
  while (grid < layout.shot_points && static_cast<float>(grid * grid) < points) ++grid;
  return grid;
}

std::uint32_t key_of(const Scene& scene, const Shoot& shoot) {
  std::uint32_t key = protocol::hash_combine(scene.layout.seed, scene.patches[shoot.patch].number);
  key = protocol::hash_combine(key, shoot.side * 2U + static_cast<std::uint32_t>(shoot.kind));
  return protocol::hash_combine(key, shoot.number);
}

/// Sets up the current point: its share of the flux, its place.
void begin_point(Pe& pe) {
  Shot& shot = pe.shot;
  shot.rest = {};
  shot.next_pixel = 0;
  const Patch& patch = pe.scene.patches[shot.command.patch];
  shot.point_key = protocol::hash_combine(shot.key, shot.point);
  shot.within = protocol::stratified_pair(shot.point, shot.key);
  place_point(pe.scene, shot);
  shot.seeks = seek_face(pe.scene.layout, shot.origin, pe.scene.subspaces[patch.subspace].cell) != protocol::kFaces;

  const protocol::Polygon& polygon = pe.scene.polygons[shot.polygon];
  const glm::vec3 front = unit_normal(polygon);
  const glm::vec3 away = shot.command.side == 0 ? front : -front;
  const glm::vec3 across = glm::normalize(to_vector(polygon.corner[1]) - to_vector(polygon.corner[0]));
  shot.frame = spun({across, glm::cross(away, across), away}, protocol::uniform(shot.key, Dimension::spin));
}

/// Moves on to the next pixel that gets any flux. False: the shot is over.
bool next_pixel(Pe& pe) {
  Shot& shot = pe.shot;
  const HemicubeGrid& grid = pe.scene.hemicube_grid;
  for (;;) {
    if (shot.next_pixel == protocol::hemicube_pixels(grid.n)) {
      if (++shot.point == shot.grid * shot.grid) return false;
      begin_point(pe);
    }
    shot.pixel = shot.next_pixel++;
    const std::uint32_t weight = pe.scene.hemicube[entry_of(grid.n, hemicube_pixel(grid, shot.pixel))].weight;
    std::int64_t any = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      shot.pixel_flux[c] = protocol::next_part(shot.share[c], weight, shot.rest[c]);
      any |= shot.pixel_flux[c];
    }
    if (any != 0) return true;
  }
}

void create_record(Pe& pe, Niu& niu) {
  const Shot& shot = pe.shot;
  const Patch& patch = pe.scene.patches[shot.command.patch];
  // Anywhere in the pixel: through the middle of each, what is small would get too little or too much, however many
  // hemi-cubes there are. The shot's points share the pixel out among themselves: to what is far away they are one
  // hemi-cube of so many times the pixels. In each pixel the points' places are shifted (by exclusive or) by numbers of
  // its own: they keep as far apart, and pixels have nothing to do with each other.
  const HemicubeGrid& grid = pe.scene.hemicube_grid;
  const std::uint32_t shift = protocol::hash_combine(shot.key, shot.pixel);
  const HemicubePixel pixel = hemicube_pixel(grid, shot.pixel);
  const glm::vec3 direction =
      pixel_direction(shot.frame, grid, pixel, pe.scene.hemicube[entry_of(grid.n, pixel)],
                      {protocol::uniform_float(shot.within.x ^ shift),
                       protocol::uniform_float(shot.within.y ^ protocol::hash_combine(shift, 1))});
  const Slot slot = pe.slots.take(niu);
  auto& record = pe.slots.at<protocol::RadiosityRecord>(slot);
  record.origin = to_array(shot.origin);
  record.direction = to_array(direction);
  record.flux = shot.pixel_flux;
  record.subspace = patch.subspace;
  record.polygon = pe.scene.polygons[shot.polygon].number;
  record.key = shot.point_key ^ shift;
  record.kind = shot.seeks ? protocol::RecordKind::seek : protocol::RecordKind::light;
  record.bounce = 0;
  record.flags =
      static_cast<std::uint8_t>(protocol::kFirst | (shot.command.kind == ShotKind::emitted ? protocol::kDirect : 0U));
  record.visited = 0;
  ++pe.tally.rays;
  follow_light(pe, niu, slot);
}

/// Credits that were not needed go home before the shot is reported done.
void end_shot(Pe& pe, Niu& niu) {
  pe.shot.active = false;
  const protocol::ShotDone done{pe.shot.granted - pe.shot.credits};
  if (pe.shot.credits > 0) pe.homecoming.add_credits(niu, pe.shot.credits);
  pe.shot.credits = 0;
  pe.homecoming.flush(niu);
  niu.send(protocol::MessageKind::shot_done, done);
}

}  // namespace

void begin_shot(Pe& pe, Niu& niu, const Shoot& shoot) {
  const PhaseMark<Phase::shoot> mark(niu);
  Shot& shot = pe.shot;
  shot.command = shoot;
  shot.flux = withdraw(pe, niu, shot.command);
  shot.grid = grid_of(pe.scene.layout, shot);
  shot.key = key_of(pe.scene, shot.command);
  shot.active = true;
  shot.point = 0;
  shot.credits = 0;
  shot.granted = 0;
  begin_points(pe.scene, shot);
  begin_point(pe);
  if (!next_pixel(pe)) end_shot(pe, niu);
}

void grant_credits(Pe& pe, Niu& niu, std::uint32_t credits) {
  const PhaseMark<Phase::shoot> mark(niu);
  if (!pe.shot.active) {  // granted before the host knew that the shot was over
    pe.homecoming.add_credits(niu, credits);
    return;
  }
  pe.shot.credits += credits;
  pe.shot.granted += credits;
  while (pe.shot.credits > 0) {
    --pe.shot.credits;
    create_record(pe, niu);
    if (!next_pixel(pe)) {
      end_shot(pe, niu);
      return;
    }
  }
}

}  // namespace torolux::pe
