// SPDX-License-Identifier: MIT
// Next-event estimation (Kajiya 1986, The Rendering Equation): emitters by their power, a point on each by area, or by
// solid angle where it is near; of several such points one by the light that it would bring (Talbot, Cline & Egbert
// 2005, Importance Resampling for Global Illumination).
#include "firmware/pe/emitters.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <numbers>

#include "firmware/pe/lamps.hpp"
#include "firmware/pe/spherical_triangle.hpp"
#include "firmware/pe/surface.hpp"
#include "firmware/protocol/random.hpp"

namespace torolux::pe {
namespace {

using protocol::Emitter;

/// Light of one sample, in units of the emitter's radiance. Only points very near to a measured lamp can reach that, or
/// near to what emits a thousandth of all light: a few samples that would outshine all others, and in the end overflow
/// a pixel.
constexpr float kMostSeen = 1024.0F;
/// An emitter is near up to so many times its extent, the root of twice its area, from its first corner and its plane.
constexpr float kNearCorner = 1.5F;
constexpr float kNearPlane = 0.25F;
/// Points among which one is chosen by the light that it would bring were nothing before it.
constexpr std::uint32_t kMostCandidates = 16;

/// The emitter of one number.
struct Choice {
  const Emitter& emitter;
  float chance;  ///< of the emitter, times 2^32
  float place;   ///< of the number among all those that choose it: 0..1, again uniform
};

Choice choose(const Scene& scene, std::uint32_t word) {
  const auto chosen = std::lower_bound(scene.emitters.begin(), scene.emitters.end(), word,
                                       [](const Emitter& emitter, std::uint32_t w) { return emitter.chosen_to < w; });
  const std::uint32_t first = chosen == scene.emitters.begin() ? 0 : std::prev(chosen)->chosen_to + 1U;
  const float chance = static_cast<float>(chosen->chosen_to - first) + 1.0F;
  return {*chosen, chance, static_cast<float>(word - first) / chance};
}

/// Uniform over the triangle; numbers that keep apart give points that do (Heitz 2019, A Low-Distortion Map Between
/// Triangle and Square).
glm::vec3 point_on(const Emitter& emitter, float a, float b) {
  if (a < b) {
    a *= 0.5F;
    b -= a;
  } else {
    b *= 0.5F;
    a -= b;
  }
  return (to_vector(emitter.corner[0]) * ((1.0F - a) - b) + to_vector(emitter.corner[1]) * a) +
         to_vector(emitter.corner[2]) * b;
}

/// Whether a way leads out through this half of an opening (Moeller & Trumbore 1997, Fast, Minimum Storage Ray/Triangle
/// Intersection). What lies on its edge is let through: of two halves either will do.
bool leads_through(const Emitter& half, const glm::vec3& point, const glm::vec3& direction) {
  const glm::vec3 first = to_vector(half.corner[1]) - to_vector(half.corner[0]);
  const glm::vec3 second = to_vector(half.corner[2]) - to_vector(half.corner[0]);
  const glm::vec3 across = glm::cross(direction, second);
  const float determinant = glm::dot(first, across);
  if (determinant == 0.0F) return false;
  const float inverse = 1.0F / determinant;
  const glm::vec3 way = point - to_vector(half.corner[0]);
  const float u = glm::dot(way, across) * inverse;
  const glm::vec3 aside = glm::cross(way, first);
  const float v = glm::dot(direction, aside) * inverse;
  return u >= 0.0F && v >= 0.0F && u + v <= 1.0F && glm::dot(second, aside) * inverse > 0.0F;
}

/// Through one of the openings, which stand before the sun in the list; where there are none, everywhere.
bool lets_sun_in(const Scene& scene, const glm::vec3& point, const glm::vec3& direction) {
  bool any = false;
  for (std::size_t i = scene.emitters.size() - 1U; i-- > 0;) {
    const Emitter& emitter = scene.emitters[i];
    if (emitter.polygon != protocol::kSkyTarget || emitter.both_sides != protocol::kSkyThroughOpening) break;
    if (leads_through(emitter, point, direction)) return true;
    any = true;
  }
  return !any;
}

/// Of the sky without its sun, or of the sun alone: a direction by what comes from there. False: none comes to this
/// side.
bool sample_by_radiance(const Scene& scene, const Emitter& emitter, float place, float v, const glm::vec3& normal,
                        const glm::vec3& geometric, EmitterSample& sample) {
  // The sun's words are the last.
  const bool of_sun = emitter.both_sides == protocol::kSkySun;
  const std::uint32_t last_of_sky = scene.sky[protocol::kSkyCells - 1U].chosen_to;
  const std::uint32_t begin = of_sun ? last_of_sky + 1U : 0U;
  const std::uint32_t most = of_sun ? 0xFFFF'FFFFU - begin : last_of_sky;
  const float upto = place * static_cast<float>(most);
  const std::uint32_t word = begin + (upto < static_cast<float>(most) ? static_cast<std::uint32_t>(upto) : most);
  const protocol::SkySample from = protocol::sample_sky(scene.layout.sky_frame, scene.sky, word, v);
  sample.direction = to_vector(from.direction);
  sample.polygon = emitter.polygon;
  const float leaving = glm::dot(sample.direction, normal);
  if (!(leaving > 0.0F) || !(glm::dot(sample.direction, geometric) > 0.0F)) return false;
  const float share = static_cast<float>(most) * 0x1p-32F;  // its chance within sky and sun together
  sample.irradiance_over_pi = to_vector(from.radiance_by_solid_angle) * (leaving * emitter.area_over_chance * share);
  return true;
}

bool is_sun(const Emitter& emitter) {
  return emitter.polygon == protocol::kSkyTarget && emitter.both_sides == protocol::kSkySun;
}

/// The largest of a way's three parts, as the bits of a float: they are ordered as floats are.
std::int32_t extent(const glm::vec3& way) {
  constexpr std::int32_t kNoSign = 0x7FFF'FFFF;
  return std::max(std::max(bits(way.x) & kNoSign, bits(way.y) & kNoSign), bits(way.z) & kNoSign);
}

/// Whether points spread evenly over the emitter would bring light as unlike as their distances: some may be near.
bool is_near(const Choice& choice, const glm::vec3& point) {
  const Emitter& emitter = choice.emitter;
  const glm::vec3 first = to_vector(emitter.corner[0]);
  const glm::vec3 away = point - first;
  const float twice_area = emitter.area_over_chance * choice.chance * (2.0F * std::numbers::pi_v<float> * 0x1p-32F);
  const float far = std::bit_cast<float>(extent(away));
  if (far * far >= twice_area * (kNearCorner * kNearCorner)) return false;
  const float volume =
      glm::dot(away, glm::cross(to_vector(emitter.corner[1]) - first, to_vector(emitter.corner[2]) - first));
  return volume * volume < (twice_area * twice_area) * (twice_area * (kNearPlane * kNearPlane));
}

/// Of a direction, to the side that is seen; 0: it leads into the surface.
float leaving_cosine(const glm::vec3& direction, const glm::vec3& normal, const glm::vec3& geometric) {
  const float leaving = glm::dot(direction, normal);
  return leaving > 0.0F && glm::dot(direction, geometric) > 0.0F ? leaving : 0.0F;
}

bool is_opening(const Emitter& emitter) {
  return emitter.polygon == protocol::kSkyTarget && emitter.both_sides == protocol::kSkyThroughOpening;
}

glm::vec3 radiance_from(const Scene& scene, const Emitter& emitter, const glm::vec3& direction) {
  if (!is_opening(emitter)) return to_vector(emitter.emission);
  return to_vector(protocol::radiance_without_sun(scene.layout.sky_frame, scene.sky, to_array(direction)));
}

/// Near an emitter: no direction brings much more than another. False: no light comes from there. Apart, as it needs
/// many registers that all others would save.
[[gnu::noinline]] bool sample_by_solid_angle(const Scene& scene, const Emitter& emitter, float place, float v,
                                             const glm::vec3& point, const glm::vec3& normal,
                                             const glm::vec3& geometric, EmitterSample& sample) {
  std::array<glm::vec3, 3> ways;
  for (std::size_t i = 0; i < 3; ++i) {
    ways[i] = to_vector(emitter.corner[i]) - point;
    if (!(glm::dot(ways[i], ways[i]) > 0.0F)) return false;
  }
  const SphericalTriangle seen = as_seen(ways);
  sample.direction = direction_into(seen, place, v);
  const glm::vec3 twice_area = glm::cross(ways[1] - ways[0], ways[2] - ways[0]);
  if (emitter.both_sides != 1U && !(glm::dot(sample.direction, twice_area) < 0.0F)) return false;
  const float leaving = leaving_cosine(sample.direction, normal, geometric);
  if (!(leaving > 0.0F)) return false;
  const float part = leaving * emitter.area_over_chance * (4.0F * seen.half_angle) / glm::length(twice_area);
  sample.irradiance_over_pi = radiance_from(scene, emitter, sample.direction) * (part < kMostSeen ? part : kMostSeen);
  return true;
}

/// One point by the emitters' power alone. False: no light comes from there.
bool sample_by_power(const Scene& scene, const protocol::StratifiedPair& numbers, const glm::vec3& point,
                     const glm::vec3& normal, const glm::vec3& geometric, EmitterSample& sample) {
  const float v = protocol::uniform_float(numbers.y);
  const Choice choice = choose(scene, numbers.x);
  const Emitter& emitter = choice.emitter;
  if (is_sun(emitter)) return false;
  if (emitter.polygon == protocol::kSkyTarget && !is_opening(emitter))
    return sample_by_radiance(scene, emitter, choice.place, v, normal, geometric, sample);
  sample.polygon = emitter.polygon;
  const bool is_lamp = emitter.lamp != protocol::kNoLamp;
  if (!is_lamp && is_near(choice, point))
    return sample_by_solid_angle(scene, emitter, choice.place, v, point, normal, geometric, sample);
  const glm::vec3 way = point_on(emitter, choice.place, v) - point;
  const float square = glm::dot(way, way);
  if (!(square > 0.0F)) return false;
  sample.direction = way * (1.0F / std::sqrt(square));
  const float leaving = leaving_cosine(sample.direction, normal, geometric);
  if (!(leaving > 0.0F)) return false;
  if (is_lamp) {
    const float near = leaving * emitter.area_over_chance / square;
    sample.irradiance_over_pi =
        lamp_light(scene, emitter.lamp, -sample.direction) * to_vector(emitter.emission) * std::min(near, kMostSeen);
    return true;
  }
  float arriving = -glm::dot(sample.direction, unit_normal(emitter.corner));
  if (emitter.both_sides == 1U) arriving = std::fabs(arriving);
  if (!(arriving > 0.0F)) return false;
  const float seen = leaving * arriving * emitter.area_over_chance / square;
  sample.irradiance_over_pi = radiance_from(scene, emitter, sample.direction) * (seen < kMostSeen ? seen : kMostSeen);
  return true;
}

/// Of the sky at least so many: a surface sees half of it, and most what stands above it.
constexpr std::uint32_t kSkyCandidates = 4;

/// A triangle or two, as lamps of one piece have, are alike from nearly everywhere. The sky is the last of all but its
/// sun.
std::uint32_t candidates_of(const Scene& scene) {
  const std::uint32_t suns = is_sun(scene.emitters.back()) ? 1U : 0U;
  const auto emitters = static_cast<std::uint32_t>(scene.emitters.size()) - suns;
  if (emitters == 0) return 0;
  const std::uint32_t least = scene.emitters[emitters - 1U].polygon == protocol::kSkyTarget ? kSkyCandidates : 1U;
  return emitters <= 2U ? least : std::clamp(emitters - 1U, least, kMostCandidates);
}

}  // namespace

float brings(const EmitterSample& sample) {
  const glm::vec3& light = sample.irradiance_over_pi;
  return (light.x + light.y) + light.z;
}

bool sample_emitter(const Scene& scene, const protocol::StratifiedTriple& numbers, const glm::vec3& point,
                    const glm::vec3& normal, const glm::vec3& geometric, EmitterSample& sample) {
  const std::uint32_t candidates = candidates_of(scene);
  if (candidates == 0) return false;
  if (candidates == 1U) return sample_by_power(scene, {numbers.x, numbers.y}, point, normal, geometric, sample);
  // Each has its own part of all emitters' power, so that none with as much is ever left out, and the same one in all
  // samples of a pixel: choices that keep apart choose emitters that do.
  const auto candidate = [&](std::uint32_t i, EmitterSample& of) {
    const protocol::StratifiedPair here{i * (0xFFFF'FFFFU / candidates) + numbers.z / candidates,
                                        numbers.y + i * 0x9E37'79B9U};
    return sample_by_power(scene, here, point, normal, geometric, of);
  };
  std::array<float, kMostCandidates> upto{};  // what this candidate and those before it would bring
  float all = 0.0F;
  for (std::uint32_t i = 0; i < candidates; ++i) {
    if (EmitterSample here; candidate(i, here)) all += brings(here);
    upto[i] = all;
  }
  if (!(all > 0.0F)) return false;
  const float at = protocol::uniform_float(numbers.x) * all;
  std::uint32_t chosen = 0;
  while (chosen + 1U < candidates && !(at < upto[chosen])) ++chosen;
  candidate(chosen, sample);
  sample.irradiance_over_pi *= all / (brings(sample) * static_cast<float>(candidates));
  return true;
}

bool sample_sun(const Scene& scene, const protocol::StratifiedTriple& numbers, const glm::vec3& point,
                const glm::vec3& normal, const glm::vec3& geometric, EmitterSample& sample) {
  const Emitter& sun = scene.emitters.back();
  return is_sun(sun) &&
         sample_by_radiance(scene, sun, protocol::uniform_float(numbers.x), protocol::uniform_float(numbers.y), normal,
                            geometric, sample) &&
         lets_sun_in(scene, point, sample.direction);
}

}  // namespace torolux::pe
