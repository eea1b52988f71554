// SPDX-License-Identifier: MIT
// Camera rays of tiles. Enters: tiles and credits; leaves: records, each of which is followed at once. All samples of a
// pixel come in a row, so that what ends here joins one addition to the frame buffer.
#include "firmware/pe/tile.hpp"
#include "firmware/protocol/fault_fields.hpp"

#include "firmware/pe/pe.hpp"
#include "firmware/pe/sky.hpp"
#include "firmware/protocol/first_cell.hpp"

namespace torolux::pe {
namespace {

using protocol::CameraView;
using protocol::RayRecord;
using protocol::Tile;
using protocol::Vec3f;

using protocol::StoreIndex;

void require(Niu& niu, bool holds, StoreIndex index, std::uint32_t value, std::uint32_t limit) {
  if (!holds) niu.fail(FaultCode::outside_store, static_cast<std::uint32_t>(index), value, limit);
}

void begin_pixel(const Scene& scene, Tiles& tiles) {
  const Tile& tile = tiles.place[tiles.first];
  tiles.sample = tiles.first_sample;
  tiles.made = 0;
  tiles.pixel = protocol::camera_pixel(scene.layout.view, tile.column + tiles.column, tile.row + tiles.row);
}

void begin_tile(const Scene& scene, Tiles& tiles) {
  tiles.column = 0;
  tiles.row = 0;
  begin_pixel(scene, tiles);
}

/// On to the next sample, pixel, tile.
void advance(Pe& pe) {
  Tiles& tiles = pe.tiles;
  if (++tiles.made < tiles.count) {
    tiles.sample += tiles.step;
    if (tiles.sample >= pe.scene.layout.view.samples) tiles.sample -= pe.scene.layout.view.samples;
    return;
  }
  const Tile& tile = tiles.place[tiles.first];
  if (++tiles.column == tile.columns) {
    tiles.column = 0;
    ++tiles.row;
  }
  if (tiles.row < tile.rows) {
    begin_pixel(pe.scene, tiles);
    return;
  }
  ++pe.done.points;
  tiles.first = (tiles.first + 1U) % protocol::kTilePlaces;
  if (--tiles.held > 0) begin_tile(pe.scene, tiles);
}

/// Where a ray begins that leaves the eye itself. False: it misses the object space.
bool find_start(const Pe& pe, RayRecord& record) {
  record.place = pe.tiles.eye_cell;
  record.flags = protocol::kFirst;
  if (pe.tiles.eye_inside) return true;
  const protocol::GridShape grid = grid_of(pe.scene.layout);
  const auto start = protocol::cell_of_entry(grid, protocol::RayPlanes(grid, record.origin, record.direction),
                                             record.origin, record.direction);
  if (!start) return false;
  record.place = protocol::cell_code(start->cell);
  record.flags = start->flags;
  return true;
}

/// Of one that leaves the lens, which may lie partly inside the object space.
bool find_lens_start(const Pe& pe, RayRecord& record) {
  const auto start = protocol::first_cell(grid_of(pe.scene.layout), record.origin, record.direction);
  if (!start) return false;
  record.place = protocol::cell_code(start->cell);
  record.flags = start->flags;
  return true;
}

/// Takes a credit, unless the ray misses the object space.
void make_ray(Pe& pe, Niu& niu) {
  const Tiles& tiles = pe.tiles;
  const CameraView& view = pe.scene.layout.view;
  const protocol::SamplePlace& place = pe.scene.sample_places[tiles.sample];
  const Slot slot = pe.slots.take(niu);
  auto& record = pe.slots.at<RayRecord>(slot);
  const bool lens = protocol::has_lens(view);
  const protocol::LensRay ray =
      lens ? protocol::lens_ray(view, tiles.pixel, tiles.sample, place, pe.scene.filter)
           : protocol::LensRay{view.eye, protocol::camera_direction(view, tiles.pixel, place, pe.scene.filter)};
  record.origin = ray.origin;
  record.direction = ray.direction;
  if (!(lens ? find_lens_start(pe, record) : find_start(pe, record))) {
    pe.slots.free_own(slot);
    if (pe.scene.sky.empty()) return;
    const glm::vec3 light = sky_towards(pe.scene, to_vector(ray.direction)) * tiles.weight;
    pe.results.add_pixel(niu, tiles.pixel.number, light * pe.scene.layout.pixel_scale);
    return;
  }
  record.weight = {tiles.weight, tiles.weight, tiles.weight};
  record.polygon = protocol::kNoPolygon;
  record.key = protocol::camera_key(tiles.pixel, tiles.sample);
  record.pixel = tiles.pixel.number;
  record.target = protocol::kNoPolygon;
  record.kind = protocol::RecordKind::light;
  record.bounce = 0;
  record.waiting = 0;
  record.sample = static_cast<std::uint16_t>(tiles.sample);
  record.visited = 0;
  --pe.credits.in_hand;
  ++pe.done.records;
  follow_ray(pe, niu, slot);
}

}  // namespace

void Tiles::set(const protocol::StageLayout& layout) {
  *this = {};
  if (layout.sample_places.count == 0) return;
  count = layout.view.samples;
  step = 1;
  weight = 1.0F / static_cast<float>(layout.view.samples);
  eye_inside = protocol::lies_inside(grid_of(layout), layout.view.eye);
  eye_cell = cell_of(layout, to_vector(layout.view.eye));
}

void take_view(Pe& pe, Niu& niu, const protocol::View& view) {
  protocol::StageLayout& layout = pe.scene.layout;
  layout.view = view.camera;
  check_view(niu, layout);
  const std::uint32_t samples = view.camera.samples;
  require(niu, view.count > 0 && view.first < samples && view.count <= samples - view.first, StoreIndex::view_first,
          view.first, samples);
  require(niu, view.step < samples || view.step == 1, StoreIndex::view_step, view.step, samples);
  pe.tiles.set(layout);
  pe.tiles.first_sample = view.first * view.step % samples;
  pe.tiles.count = view.count;
  pe.tiles.step = view.step;
}

void take_tile(Pe& pe, Niu& niu, const Tile& tile) {
  Tiles& tiles = pe.tiles;
  const CameraView& view = pe.scene.layout.view;
  require(niu, tiles.held < protocol::kTilePlaces, StoreIndex::tile_places, tiles.held, protocol::kTilePlaces);
  require(niu, tile.columns > 0 && std::uint32_t{tile.column} + tile.columns <= view.width, StoreIndex::tile_columns,
          tile.column, view.width);
  require(niu, tile.rows > 0 && std::uint32_t{tile.row} + tile.rows <= view.height, StoreIndex::tile_rows, tile.row,
          view.height);
  tiles.place[(tiles.first + tiles.held) % protocol::kTilePlaces] = tile;
  if (++tiles.held == 1) begin_tile(pe.scene, tiles);
}

void make_rays(Pe& pe, Niu& niu, std::uint32_t most) {
  const PhaseMark<Phase::shoot> mark(niu);
  for (std::uint32_t i = 0; i < most && pe.credits.in_hand > 0 && pe.tiles.held > 0; ++i) {
    make_ray(pe, niu);
    advance(pe);
  }
}

}  // namespace torolux::pe
