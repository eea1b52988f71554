// SPDX-License-Identifier: MIT
// Caustics, followed from the light: a scene and a camera in, what they add to its picture out.
//
// A path from the eye finds a small lamp behind glass by luck alone; a path from the lamp finds what is seen each time
// (light tracing: Dutre, Lafortune & Willems 1993). Flux over glass and mirrors with interpolated normals takes
// Veach's correction, so that either way gives the same light (Veach 1997, "Robust Monte Carlo methods for light
// transport simulation", 5.3).
#pragma once

#include "tests/references/path_tracer.hpp"

namespace torolux::references {

/// Light of all paths that leave an emitter by way of one or more mirrors or glass and come to the eye straight from a
/// diffuse surface: what trace() leaves out on request. choice.samples: light paths for each pixel, so many times its
/// number of pixels in all. Unbiased.
TracedPicture trace_caustics(const World& world, const Camera& camera, const TraceChoice& choice);

}  // namespace torolux::references
