// SPDX-License-Identifier: MIT
// Next-event estimation (Kajiya 1986, The Rendering Equation): an emitter by its power, a point on it by area.
#include "firmware/pe/emitters.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "firmware/pe/surface.hpp"
#include "firmware/protocol/random.hpp"

namespace torolux::pe {
namespace {

using protocol::Emitter;

/// Light of one sample, in units of the emitter's radiance. Only points nearer to an emitter than some fiftieth of its
/// size can reach that: a few samples that would outshine all others, and in the end overflow a pixel.
constexpr float kMostSeen = 1024.0F;

/// The emitter of one number, and the place of that number among all those that choose it: 0..1, again uniform.
const Emitter& choose(const Scene& scene, std::uint32_t word, float& place) {
  const auto chosen = std::lower_bound(scene.emitters.begin(), scene.emitters.end(), word,
                                       [](const Emitter& emitter, std::uint32_t w) { return emitter.chosen_to < w; });
  const std::uint32_t first = chosen == scene.emitters.begin() ? 0 : std::prev(chosen)->chosen_to + 1U;
  place = static_cast<float>(word - first) / (static_cast<float>(chosen->chosen_to - first) + 1.0F);
  return *chosen;
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

}  // namespace

bool sample_emitter(const Scene& scene, const protocol::StratifiedPair& numbers, const glm::vec3& point,
                    const glm::vec3& normal, const glm::vec3& flat, EmitterSample& sample) {
  float place = 0.0F;
  const Emitter& emitter = choose(scene, numbers.x, place);
  const glm::vec3 way = point_on(emitter, place, protocol::uniform_float(numbers.y)) - point;
  const float square = glm::dot(way, way);
  if (!(square > 0.0F)) return false;
  sample.direction = way * (1.0F / std::sqrt(square));
  sample.polygon = emitter.polygon;
  const float leaving = glm::dot(sample.direction, normal);
  if (!(leaving > 0.0F) || !(glm::dot(sample.direction, flat) > 0.0F)) return false;
  float arriving = -glm::dot(sample.direction, unit_normal(emitter.corner));
  if (emitter.both_sides != 0) arriving = std::fabs(arriving);
  if (!(arriving > 0.0F)) return false;
  const float seen = leaving * arriving * emitter.area_over_chance / square;
  sample.irradiance_over_pi = to_vector(emitter.emission) * (seen < kMostSeen ? seen : kMostSeen);
  return true;
}

}  // namespace torolux::pe
