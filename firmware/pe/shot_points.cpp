// SPDX-License-Identifier: MIT
// Stratified points of a patch. All that its facets send is laid out in a row, facet by facet and within each along the
// path of its grid; the row is cut into equal parts, and each point lies somewhere in its own.
#include "firmware/pe/shot_points.hpp"

#include <bit>
#include <span>

#include "firmware/pe/final_gather.hpp"
#include "firmware/pe/lamps.hpp"
#include "firmware/pe/surface.hpp"
#include "firmware/protocol/flux.hpp"
#include "firmware/protocol/random.hpp"
#include "firmware/protocol/triangle_grid.hpp"

namespace torolux::pe {
namespace {

using protocol::Element;
using protocol::Facet;
using protocol::Patch;
using protocol::PointRecord;

bool is_gathering(const Shot& shot) {
  return shot.command.kind == protocol::ShotKind::gathering;
}

float sum_of(const glm::vec3& v) {
  return (v.x + v.y) + v.z;
}

/// What a facet would send, R G B; emitted light by its area, reflected light by what came to its element.
glm::vec3 sent_by(const Scene& scene, const Shot& shot, const Facet& facet) {
  if (shot.by_area) return glm::vec3(facet.of_patch);
  const Patch& patch = scene.patches[shot.command.patch];
  const Element& element =
      scene.elements[scene.patch_sides[patch.side[shot.command.side]].first_element + facet.element];
  return to_vector(element.shots.unshot) *
         glm::vec3(static_cast<float>(patch.reflectance[0]), static_cast<float>(patch.reflectance[1]),
                   static_cast<float>(patch.reflectance[2])) *
         0x1p-32F * facet.of_element;
}

glm::vec3 sent_by_all(const Scene& scene, const Shot& shot) {
  const Patch& patch = scene.patches[shot.command.patch];
  glm::vec3 all(0.0F);
  for (const Facet& facet : scene.facets.subspan(patch.first_facet, patch.facets)) all += sent_by(scene, shot, facet);
  return all;
}

void count_as_shot(const Scene& scene, const Shot& shot) {
  const Patch& patch = scene.patches[shot.command.patch];
  const std::uint32_t first = scene.patch_sides[patch.side[shot.command.side]].first_element;
  for (Element& element : scene.elements.subspan(first, patch.elements)) {
    for (std::size_t c = 0; c < 3; ++c) element.shots.shot[c] += element.shots.unshot[c];
  }
}

/// Moves on to the facet in which the row reaches `until`. Returns how far in it, 0..1.
float walk_to(const Scene& scene, const Shot& shot, float until, FacetWalk& walk) {
  const Patch& patch = scene.patches[shot.command.patch];
  for (;;) {
    const glm::vec3 here = sent_by(scene, shot, scene.facets[patch.first_facet + walk.facet]);
    const float into = until - sum_of(walk.before);
    const float length = sum_of(here);
    if (into < length) return into > 0.0F ? into / length : 0.0F;
    if (walk.facet + 1U == patch.facets) return 1.0F;
    walk.before += here;
    ++walk.facet;
  }
}

/// The point of a facet so far along its path: successive digits in base 4 choose among four children (K. Basu,
/// A. Owen, "Low discrepancy constructions in the triangle", SIAM Journal on Numerical Analysis 53(2), 2015).
glm::vec3 point_of(const protocol::Polygon& polygon, std::uint32_t code, float along) {
  constexpr std::uint32_t all = 2U * protocol::kMostLevels;
  const std::uint32_t known = 2U * protocol::level_of_code(code);
  const auto fraction = static_cast<std::uint32_t>(along * static_cast<float>(1U << all));
  const std::uint32_t digits = (along < 1.0F ? fraction : (1U << all) - 1U) >> known;
  const std::uint32_t path = protocol::path_of_code(code) << (all - known) | digits;
  const auto middle = protocol::middle_of_grid_triangle(path, protocol::kMostLevels);
  constexpr float unit = 1.0F / (3.0F * static_cast<float>(1U << protocol::kMostLevels));
  glm::vec3 point(0.0F);
  for (std::size_t i = 0; i < 3; ++i) point += to_vector(polygon.corner[i]) * (static_cast<float>(middle[i]) * unit);
  return point;
}

/// Of a gathering: elements follow each other in a row, each as long as the next, so that with a point or more for each
/// none is left out; within one, its facets as far as light comes there. All points lie as far on in their parts of the
/// row. Moves on to the point's facet; returns how far in it, 0..1.
float walk_to_element(const Scene& scene, Shot& shot) {
  const Patch& patch = scene.patches[shot.command.patch];
  const auto facets = scene.facets.subspan(patch.first_facet, patch.facets);
  const std::uint32_t shift =
      protocol::hash_combine(shot.key, static_cast<std::uint32_t>(protocol::Dimension::place)) >> 16U;
  const std::uint64_t at = ((std::uint64_t{shot.point} << 16U) | shift) * patch.elements;
  const std::uint64_t part = std::uint64_t{shot.points} << 16U;
  const auto element = static_cast<std::uint32_t>(at / part);
  std::uint32_t& facet = shot.walk.facet;
  while (facet + 1U < patch.facets && facets[facet].element < element) ++facet;
  std::uint32_t first = facet;
  while (first > 0 && facets[first - 1U].element == facets[facet].element) --first;
  float all = 0.0F;
  for (std::uint32_t f = first; f < patch.facets && facets[f].element == facets[first].element; ++f)
    all += facets[f].of_element;
  float until = (static_cast<float>(static_cast<std::uint32_t>(at - element * part)) / static_cast<float>(part)) * all;
  for (facet = first; facet + 1U < patch.facets && facets[facet + 1U].element == facets[first].element; ++facet) {
    if (until < facets[facet].of_element) break;
    until -= facets[facet].of_element;
  }
  return until < facets[facet].of_element ? until / facets[facet].of_element : 1.0F;
}

/// The flux of all points up to the current one, by how much of each channel the facets up to there send.
protocol::Flux given_until(const Scene& scene, const Shot& shot, float into) {
  const Patch& patch = scene.patches[shot.command.patch];
  const glm::vec3 until =
      shot.walk.before + sent_by(scene, shot, scene.facets[patch.first_facet + shot.walk.facet]) * into;
  protocol::Flux given{};
  for (int c = 0; c < 3; ++c) {
    const float part = shot.all[c] > 0.0F ? until[c] / shot.all[c] : sum_of(until) / sum_of(shot.all);
    const std::int64_t flux = shot.flux[static_cast<std::size_t>(c)];
    // 24 digits are what a float has; scaled down by them, nothing needs 64-bit conversions.
    const auto fraction = static_cast<std::uint32_t>((part < 1.0F ? part : 1.0F) * 0x1p24F);
    const std::int64_t upto = protocol::scale_down(flux, std::uint64_t{fraction} << 8U);
    const std::int64_t before = shot.given[static_cast<std::size_t>(c)];
    given[static_cast<std::size_t>(c)] = upto > before ? upto : before;
  }
  return given;
}

/// All of the shot's next point but its flux.
PointRecord point_on(const Scene& scene, const Shot& shot, const Facet& facet, float along) {
  const protocol::Polygon& polygon = scene.polygons[facet.polygon];
  const glm::vec3 origin = point_of(polygon, facet.code, along);
  const glm::vec3 front = unit_normal(polygon);
  PointRecord point{};
  point.origin = to_array(origin);
  point.normal = to_array(shot.command.side == 0 ? front : -front);
  point.place = cell_of(scene.layout, origin);
  point.polygon = polygon.number;
  point.key = shot.key;
  point.kind = protocol::RecordKind::point;
  point.number_low = static_cast<std::uint8_t>(shot.point);
  point.number_high = static_cast<std::uint8_t>(shot.point >> 8U);
  point.flags = shot.apart ? protocol::kApart : std::uint8_t{0};
  if (shot.command.kind != protocol::ShotKind::emitted) return point;
  point.flags = protocol::kDirect;
  const std::uint32_t lamp = scene.materials[polygon.material].lamp;
  if (lamp != protocol::kNoLamp) name_lamp(lamp, shot.command.side, point);
  return point;
}

}  // namespace

void begin_points(const Scene& scene, Shot& shot) {
  shot.walk = {};
  shot.given = {};
  shot.by_area = shot.command.kind == protocol::ShotKind::emitted;
  if (is_gathering(shot)) return;
  shot.all = sent_by_all(scene, shot);
  if (!shot.by_area) count_as_shot(scene, shot);
  if (sum_of(shot.all) > 0.0F) return;
  shot.by_area = true;  // so little that rounding hid where it came
  shot.all = sent_by_all(scene, shot);
}

protocol::PointRecord make_point(const Scene& scene, Shot& shot, protocol::PeNumber home) {
  const std::span<const Facet> facets = scene.facets.subspan(scene.patches[shot.command.patch].first_facet);
  if (is_gathering(shot)) {
    const float along = walk_to_element(scene, shot);
    const Facet& facet = facets[shot.walk.facet];
    const PointRecord point = point_on(scene, shot, facet, along);
    ++shot.point;
    return std::bit_cast<PointRecord>(gathering_point(scene, shot.command, facet.element, home, point));
  }
  const float part = sum_of(shot.all) / static_cast<float>(shot.points);
  const auto begin = static_cast<float>(shot.point);
  const std::uint32_t key = protocol::hash_combine(shot.key, shot.point);
  const float at = begin + protocol::uniform(key, protocol::Dimension::place);
  const float along = walk_to(scene, shot, at * part, shot.walk);
  PointRecord point = point_on(scene, shot, facets[shot.walk.facet], along);

  const bool last = shot.point + 1U == shot.points;
  const float into = walk_to(scene, shot, (begin + 1.0F) * part, shot.walk);
  const protocol::Flux given = last ? shot.flux : given_until(scene, shot, into);
  for (std::size_t c = 0; c < 3; ++c) point.flux[c] = given[c] - shot.given[c];
  shot.given = given;
  ++shot.point;
  return point;
}

}  // namespace torolux::pe
