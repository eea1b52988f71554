// SPDX-License-Identifier: MIT
// Next-event estimation (Kajiya 1986, The Rendering Equation): an emitter by its power, a point on it by area.
#include "firmware/pe/emitters.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/protocol/random.hpp"

namespace torolux::pe {
namespace {

using protocol::Dimension;
using protocol::Emitter;

/// Light of one sample, in units of the emitter's radiance. Only points nearer to an emitter than some fiftieth of its
/// size can reach that: a few samples that would outshine all others, and in the end overflow a pixel.
constexpr float kMostSeen = 1024.0F;

const Emitter& choose(const Scene& scene, std::uint32_t key) {
  const std::uint32_t word = protocol::hash_combine(key, static_cast<std::uint32_t>(Dimension::emitter));
  return *std::lower_bound(scene.emitters.begin(), scene.emitters.end(), word,
                           [](const Emitter& emitter, std::uint32_t w) { return emitter.chosen_to < w; });
}

/// Uniform over the triangle (Turk 1990, Generating Random Points in Triangles).
glm::vec3 point_on(const Emitter& emitter, std::uint32_t key) {
  const float root = std::sqrt(protocol::uniform(key, Dimension::emitter_a));
  const float b2 = protocol::uniform(key, Dimension::emitter_b) * root;
  const float b1 = root - b2;
  return (to_vector(emitter.corner[0]) * (1.0F - root) + to_vector(emitter.corner[1]) * b1) +
         to_vector(emitter.corner[2]) * b2;
}

}  // namespace

bool sample_emitter(const Scene& scene, std::uint32_t key, const glm::vec3& point, const glm::vec3& normal,
                    const glm::vec3& flat, EmitterSample& sample) {
  const Emitter& emitter = choose(scene, key);
  const glm::vec3 way = point_on(emitter, key) - point;
  const float square = glm::dot(way, way);
  if (!(square > 0.0F)) return false;
  sample.direction = way * (1.0F / std::sqrt(square));
  sample.polygon = emitter.polygon;
  const float leaving = glm::dot(sample.direction, normal);
  if (!(leaving > 0.0F) || !(glm::dot(sample.direction, flat) > 0.0F)) return false;
  const glm::vec3 corner = to_vector(emitter.corner[0]);
  const glm::vec3 front = glm::normalize(glm::cross(glm::normalize(to_vector(emitter.corner[1]) - corner),
                                                    glm::normalize(to_vector(emitter.corner[2]) - corner)));
  float arriving = -glm::dot(sample.direction, front);
  if (emitter.both_sides != 0) arriving = std::fabs(arriving);
  if (!(arriving > 0.0F)) return false;
  const float seen = leaving * arriving * emitter.area_over_chance / square;
  sample.irradiance_over_pi = to_vector(emitter.emission) * (seen < kMostSeen ? seen : kMostSeen);
  return true;
}

}  // namespace torolux::pe
