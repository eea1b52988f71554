// SPDX-License-Identifier: MIT
// A point of an opening becomes as many records as any other, but each enters elsewhere in the opening and from a
// direction drawn by the sky's radiance: light from far away is parallel, and from one place would light one spot.
#include "firmware/pe/sky.hpp"

#include "firmware/protocol/random.hpp"
#include "firmware/protocol/record_key.hpp"

namespace torolux::pe {
namespace {

/// Word of the chain by which records' places in an opening have nothing to do with their directions.
constexpr std::uint32_t kPlaces = 1;

/// 0 and up; of 1 and more all, which takes a channel that the others outshine a hundred times.
protocol::Fraction fraction_of(float part) {
  return part < 1.0F ? protocol::Fraction{static_cast<std::uint32_t>(part * 0x1p32F)} : protocol::kOne;
}

}  // namespace

glm::vec3 sky_towards(const Scene& scene, const glm::vec3& direction) {
  if (scene.sky.empty()) return glm::vec3(0.0F);
  return to_vector(protocol::sky_radiance(scene.layout.sky_frame, scene.sky, to_array(direction)));
}

void see_sky(Pe& pe, Niu& niu, const protocol::RayRecord& record) {
  if (pe.scene.sky.empty()) return;
  glm::vec3 light = to_vector(record.weight);
  if ((record.flags & protocol::kShadow) != 0) {
    if (record.target != protocol::kSkyTarget) return;
  } else {
    light *= sky_towards(pe.scene, to_vector(record.direction));
  }
  pe.results.add_pixel(niu, record.pixel, light * pe.scene.layout.pixel_scale);
}

void begin_sky_pixels(Pe& pe, Expansion& expansion) {
  const std::uint32_t part = (expansion.point.flags & protocol::kPartMask) >> protocol::kPartShift;
  const std::uint32_t pixels = protocol::hemicube_pixels(pe.scene.hemicube_grid.n);
  expansion.next_pixel = part == 0 ? 0U : pixels * (part - 1U) / protocol::kPointParts;
  expansion.end_pixel = part == 0 ? pixels : pixels * part / protocol::kPointParts;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::int64_t flux = expansion.point.flux[c];
    constexpr std::uint64_t kPart = protocol::kOne / protocol::kPointParts;
    const std::int64_t upto = part == 0 ? flux : protocol::scale_down(flux, kPart * part);
    const std::int64_t before = part == 0 ? 0 : protocol::scale_down(flux, kPart * (part - 1U));
    pe.tally.sky_rest[c] += upto - before;
  }
}

bool step_sky_pixel(Pe& pe, Expansion& expansion) {
  const Scene& scene = pe.scene;
  const HemicubeGrid& grid = scene.hemicube_grid;
  const std::uint32_t pixels = protocol::hemicube_pixels(grid.n);
  expansion.pixel = expansion.next_pixel++;
  const std::uint32_t shift = protocol::pixel_key(expansion.point.key, expansion.pixel);
  // Pixels share out the sky by what comes from it, and a shot's points each pixel's part.
  const std::uint32_t step = 0xFFFF'FFFFU / pixels;
  const auto within = static_cast<std::uint32_t>((std::uint64_t{expansion.within.x ^ shift} * step) >> 32U);
  const protocol::SkySample sample =
      protocol::sample_sky(scene.layout.sky_frame, scene.sky, expansion.pixel * step + within,
                           protocol::uniform_float(expansion.within.y ^ protocol::hash_combine(shift, 1)));
  const protocol::SkyOpening& opening = scene.sky_openings[expansion.point.polygon];
  const float cosine = -protocol::dot(sample.direction, opening.inwards);
  if (!(cosine > 0.0F)) return false;
  expansion.direction = -to_vector(sample.direction);
  const float share = cosine / static_cast<float>(pixels);
  std::int64_t any = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const float part = sample.radiance_by_solid_angle[c] * scene.layout.sky_frame.inverse_irradiance[c] * share;
    expansion.pixel_flux[c] = protocol::scale_down(expansion.point.flux[c], fraction_of(part));
    pe.tally.sky_rest[c] -= expansion.pixel_flux[c];
    any |= expansion.pixel_flux[c];
  }
  return any != 0;
}

glm::vec3 sky_origin(const Scene& scene, const Expansion& expansion) {
  const protocol::SkyOpening& opening = scene.sky_openings[expansion.point.polygon];
  const std::uint32_t pixels = protocol::hemicube_pixels(scene.hemicube_grid.n);
  const protocol::StratifiedPair place = protocol::stratified_pair(
      expansion.number * pixels + expansion.pixel, protocol::hash_combine(expansion.point.key, kPlaces));
  return to_vector(opening.corner) + (to_vector(opening.along) * protocol::uniform_float(place.x) +
                                      to_vector(opening.across) * protocol::uniform_float(place.y));
}

}  // namespace torolux::pe
