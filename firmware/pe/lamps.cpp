// SPDX-License-Identifier: MIT
// A lamp's point becomes as many records as any other, all with the same flux: where more light goes, more of them go.
#include "firmware/pe/lamps.hpp"

#include <algorithm>

#include "firmware/protocol/flux.hpp"
#include "firmware/protocol/random.hpp"
#include "firmware/protocol/record_key.hpp"

namespace torolux::pe {
namespace {

std::uint32_t side_towards(const protocol::Lamp& lamp, const glm::vec3& direction) {
  return glm::dot(direction, to_vector(lamp.nadir)) >= 0.0F ? 0U : 1U;
}

}  // namespace

void name_lamp(std::uint32_t lamp, std::uint32_t side, protocol::PointRecord& point) {
  point.normal = {static_cast<float>(lamp), 0.0F, 0.0F};
  point.flags |= protocol::kLamp;
  if (side != 0) point.flags |= protocol::kBackSide;
}

std::optional<protocol::LampPoint> lamp_of(const Scene& scene, const protocol::PointRecord& point) {
  const float number = point.normal[0];
  if (!(number >= 0.0F) || !(number < static_cast<float>(scene.lamps.size()))) return std::nullopt;
  const protocol::LampPoint named{static_cast<std::uint32_t>(number),
                                  (point.flags & protocol::kBackSide) != 0 ? 1U : 0U};
  if (scene.lamps[named.lamp].side[named.side].bands == 0) return std::nullopt;
  return named;
}

bool step_lamp_pixel(const Scene& scene, Expansion& expansion) {
  const std::uint32_t pixels = protocol::hemicube_pixels(scene.hemicube_grid.n);
  expansion.pixel = expansion.next_pixel++;
  // Shares add up to 2^32: the first ones have what is left over. (`pixels` has a factor of three.)
  const std::uint32_t share = 0xFFFF'FFFFU / pixels;
  const std::uint32_t left_over = 0U - share * pixels;
  const std::uint32_t weight = share + (expansion.pixel < left_over ? 1U : 0U);
  std::int64_t any = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    expansion.pixel_flux[c] = protocol::next_part(expansion.point.flux[c], weight, expansion.rest[c]);
    any |= expansion.pixel_flux[c];
  }
  if (any == 0) return false;
  // Pixels share out the lamp's light, and a shot's points each pixel's part, as those of a hemi-cube do.
  const std::uint32_t shift = protocol::pixel_key(expansion.point.key, expansion.pixel);
  const auto within = static_cast<std::uint32_t>((std::uint64_t{expansion.within.x ^ shift} * share) >> 32U);
  expansion.direction =
      to_vector(protocol::sample_lamp(scene.lamps[expansion.lamp.lamp], expansion.lamp.side, scene.lamp_values,
                                      scene.lamp_chances, expansion.pixel * share + within,
                                      protocol::uniform_float(expansion.within.y ^ protocol::hash_combine(shift, 1))));
  return true;
}

float lamp_light(const Scene& scene, std::uint32_t lamp, const glm::vec3& direction) {
  const protocol::Lamp& of = scene.lamps[lamp];
  return protocol::lamp_intensity(of, side_towards(of, direction), scene.lamp_values, to_array(direction));
}

float lamp_seen(const Scene& scene, std::uint32_t lamp, const glm::vec3& direction) {
  const float slant = std::fabs(glm::dot(direction, to_vector(scene.lamps[lamp].nadir)));
  return lamp_light(scene, lamp, direction) / std::max(slant, protocol::kLeastLampCosine);
}

}  // namespace torolux::pe
