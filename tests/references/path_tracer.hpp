// SPDX-License-Identifier: MIT
// The path tracer: a scene and a camera in, linear radiance and its noise out; or the light that falls on one point.
//
// Unbiased: paths end by Russian roulette, never by a limit. At diffuse and glossy surfaces it combines directions
// towards emitters with sampled directions by the power heuristic (Veach & Guibas 1995). Radiance that enters or leaves
// glass scales with the square of the refractive index.
#pragma once

#include <cstdint>

#include "host_tools/picture/picture.hpp"
#include "tests/references/random.hpp"
#include "tests/references/world.hpp"

namespace torolux::references {

/// How light finds emitters. The last two are for tests: each alone must give the same as both.
enum class LightFinding : std::uint8_t { both, emitters_only, directions_only };

/// Light that comes to a diffuse surface in view by way of mirrors or glass: by luck, or as light_paths.hpp has it.
/// With the latter, where such a surface is seen in mirrors or glass (or in what is glossy) in its turn, many tries in
/// place of one look for emitters.
enum class Caustics : std::uint8_t { from_eye, from_light };

struct TraceChoice {
  std::uint32_t width = 256, height = 256;
  std::uint32_t samples = 256;  ///< per pixel, even; spread evenly over the pixel's square, all of equal weight
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0: all cores; the picture is the same for any number
  LightFinding finding = LightFinding::both;
  Caustics caustics = Caustics::from_eye;
};

struct TracedPicture {
  Picture picture;
  /// Of the first and the second half of the samples: independent of each other.
  Picture first_half, second_half;
};

TracedPicture trace(const World& world, const Camera& camera, const TraceChoice& choice);

/// One sample of the light that falls on the side of a surface that `hit` names, over pi: what white paper there would
/// show [W/(m^2 sr)]. Multiply by its reflectance and pi for radiosity.
Colour incident_over_pi(const World& world, const Hit& hit, LightFinding finding, Samples& samples);

}  // namespace torolux::references
