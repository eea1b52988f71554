// SPDX-License-Identifier: MIT
// Points become records, one for each hemi-cube pixel. Enters: points and credits; leaves: records, each of which is
// followed at once.
#include <bit>

#include "firmware/pe/final_gather.hpp"
#include "firmware/pe/hemicube.hpp"
#include "firmware/pe/lamps.hpp"
#include "firmware/pe/pe.hpp"
#include "firmware/pe/sky.hpp"
#include "firmware/protocol/fault_fields.hpp"
#include "firmware/protocol/flux.hpp"
#include "firmware/protocol/random.hpp"
#include "firmware/protocol/record_key.hpp"
#include "firmware/protocol/stratified.hpp"

namespace torolux::pe {
namespace {

using protocol::Dimension;
using protocol::PointRecord;

/// Two directions at right angles to a unit vector and each other (Duff et al. 2017, Building an Orthonormal Basis,
/// Revisited, JCGT 6(1)).
Frame frame_about(const glm::vec3& z) {
  const float sign = bits(z.z) < 0 ? -1.0F : 1.0F;
  const float a = -1.0F / (sign + z.z);
  const float b = z.x * z.y * a;
  return {{1.0F + sign * z.x * z.x * a, sign * b, -sign * z.x}, {b, sign + z.y * z.y * a, -z.y}, z};
}

bool is_of_gathering(const PointRecord& point) {
  return point.kind == protocol::RecordKind::gather_point;
}

bool is_kept_apart(const PointRecord& point) {
  return (point.flags & (std::uint32_t{protocol::kApart} | protocol::kLamp)) == protocol::kApart;
}

bool is_of_sky(const PointRecord& point) {
  return (point.flags & protocol::kSky) != 0;
}

/// One pixel on. False: it gets no flux.
bool step_pixel(const Scene& scene, Expansion& expansion) {
  const HemicubeGrid& grid = scene.hemicube_grid;
  expansion.pixel = expansion.next_pixel++;
  const std::uint32_t weight = scene.hemicube[entry_of(grid.n, hemicube_pixel(grid, expansion.pixel))].weight;
  std::int64_t any = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    expansion.pixel_flux[c] = protocol::next_part(expansion.point.flux[c], weight, expansion.rest[c]);
    any |= expansion.pixel_flux[c];
  }
  return any != 0;
}

bool step(Pe& pe, Expansion& expansion) {
  if (is_of_gathering(expansion.point)) {
    expansion.pixel = expansion.next_pixel++;
    return true;
  }
  if (is_of_sky(expansion.point)) return step_sky_pixel(pe, expansion);
  if (is_of_lamp(expansion.point)) return step_lamp_pixel(pe.scene, expansion);
  return step_pixel(pe.scene, expansion);
}

/// Moves on to the next pixel that gets any flux. False: the point is done.
bool next_pixel(Pe& pe, Expansion& expansion) {
  while (expansion.next_pixel < expansion.end_pixel) {
    if (step(pe, expansion)) return true;
  }
  return false;
}

/// To the first of the pixels that are meant: those before have their shares, too, whoever makes records of them.
void begin_pixels(Pe& pe, Expansion& expansion) {
  const std::uint32_t pixels = protocol::hemicube_pixels(pe.scene.hemicube_grid.n);
  const std::uint32_t part = (expansion.point.flags & protocol::kPartMask) >> protocol::kPartShift;
  expansion.end_pixel = part == 0 ? pixels : pixels * part / protocol::kPointParts;
  const std::uint32_t begin = part == 0 ? 0U : pixels * (part - 1U) / protocol::kPointParts;
  while (expansion.next_pixel < begin) step(pe, expansion);
}

/// The next of the points that wait, until one has a record to make. False: there is none.
bool begin_point(Pe& pe) {
  Expansion& expansion = pe.expansion;
  while (pe.points.waiting > 0) {
    const PointRecord point = pe.points.place[pe.points.first];
    pe.points.first = (pe.points.first + 1U) % protocol::kPointPlaces;
    --pe.points.waiting;
    expansion = {};
    expansion.point = point;
    expansion.number = protocol::point_number(point);
    if (is_of_gathering(point)) {
      if (!(std::bit_cast<protocol::GatherPointRecord>(point).area > 0.0F)) {
        ++pe.done.points;
        continue;
      }
      expansion.frame = frame_about(to_vector(point.normal));
      begin_pixels(pe, expansion);
      expansion.active = next_pixel(pe, expansion);
      return true;
    }
    expansion.key = protocol::point_key(point.key, expansion.number);
    expansion.within = protocol::stratified_pair(expansion.number, point.key);
    if (is_of_sky(point)) {
      begin_sky_pixels(pe, expansion);
    } else {
      if (is_of_lamp(point)) {
        expansion.lamp = *lamp_of(pe.scene, point);
      } else {
        expansion.frame = spun(frame_about(to_vector(point.normal)), protocol::uniform(point.key, Dimension::spin));
      }
      begin_pixels(pe, expansion);
    }
    expansion.active = next_pixel(pe, expansion);
    if (expansion.active) return true;
    ++pe.done.points;
  }
  return false;
}

/// Of the pixel, from the point.
glm::vec3 direction_of(const Pe& pe, std::uint32_t shift) {
  const Expansion& expansion = pe.expansion;
  // Anywhere in the pixel: through the middle of each, what is small would get too little or too much, however many
  // hemi-cubes there are. The shot's points share the pixel out among themselves: to what is far away they are one
  // hemi-cube of so many times the pixels. In each pixel the points' places are shifted (by exclusive or) by numbers of
  // its own: they keep as far apart, and pixels have nothing to do with each other.
  const HemicubeGrid& grid = pe.scene.hemicube_grid;
  const HemicubePixel pixel = hemicube_pixel(grid, expansion.pixel);
  return pixel_direction(expansion.frame, grid, pixel, pe.scene.hemicube[entry_of(grid.n, pixel)],
                         {protocol::uniform_float(expansion.within.x ^ shift),
                          protocol::uniform_float(expansion.within.y ^ protocol::hash_combine(shift, 1))});
}

/// Takes a credit.
void create_record(Pe& pe, Niu& niu) {
  const Expansion& expansion = pe.expansion;
  const bool of_sky = is_of_sky(expansion.point);
  const bool drawn = of_sky || is_of_lamp(expansion.point);
  const std::uint32_t shift = protocol::pixel_key(expansion.point.key, expansion.pixel);
  const Slot slot = pe.slots.take(niu);
  auto& record = pe.slots.at<protocol::RadiosityRecord>(slot);
  record.origin = of_sky ? to_array(sky_origin(pe.scene, expansion)) : expansion.point.origin;
  record.direction = to_array(drawn ? expansion.direction : direction_of(pe, shift));
  record.flux = expansion.pixel_flux;
  record.place = of_sky ? cell_of(pe.scene.layout, to_vector(record.origin)) : expansion.point.place;
  record.polygon = of_sky ? protocol::kNoPolygon : expansion.point.polygon;
  record.key = protocol::record_key(expansion.key, shift);
  record.kind = protocol::RecordKind::light;
  record.bounce = 0;
  record.flags = static_cast<std::uint8_t>(protocol::kFirst | (expansion.point.flags & protocol::kDirect) |
                                           (is_kept_apart(expansion.point) ? protocol::kTurned : 0U));
  record.visited = 0;
  --pe.credits.in_hand;
  ++pe.tally.rays;
  ++pe.done.records;
  follow_light(pe, niu, slot);
}

}  // namespace

void take_point(Pe& pe, Niu& niu, const PointRecord& point) {
  Points& points = pe.points;
  const std::uint32_t held = points.waiting + (pe.expansion.active ? 1U : 0U);
  if (held >= protocol::kPointPlaces) {
    niu.fail(FaultCode::bad_record, static_cast<std::uint32_t>(protocol::RecordField::point_places), held);
  }
  const std::uint32_t part = (point.flags & protocol::kPartMask) >> protocol::kPartShift;
  if (part > protocol::kPointParts) {
    niu.fail(FaultCode::bad_record, static_cast<std::uint32_t>(protocol::RecordField::point_part), part);
  }
  const bool enters = is_of_gathering(point) || !is_of_sky(point) ||
                      (point.polygon < pe.scene.sky_openings.size() && !pe.scene.sky.empty());
  if (!enters) {
    niu.fail(FaultCode::bad_record, static_cast<std::uint32_t>(protocol::RecordField::opening), point.polygon);
  }
  if (!is_of_gathering(point) && is_of_lamp(point) && !lamp_of(pe.scene, point)) {
    niu.fail(FaultCode::bad_record, static_cast<std::uint32_t>(protocol::RecordField::point_lamp), point.flags);
  }
  points.place[(points.first + points.waiting) % protocol::kPointPlaces] = point;
  ++points.waiting;
}

void expand_points(Pe& pe, Niu& niu, std::uint32_t most) {
  const PhaseMark<Phase::shoot> mark(niu);
  for (std::uint32_t i = 0; i < most && pe.credits.in_hand > 0; ++i) {
    if (!pe.expansion.active && !begin_point(pe)) return;
    if (is_of_gathering(pe.expansion.point)) {
      create_gather_ray(pe, niu);
    } else {
      create_record(pe, niu);
    }
    pe.expansion.active = next_pixel(pe, pe.expansion);
    if (!pe.expansion.active) ++pe.done.points;
  }
}

}  // namespace torolux::pe
