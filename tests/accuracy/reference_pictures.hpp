// SPDX-License-Identifier: MIT
// Path traced references of scenes: made once, then kept in files until the scene, the view or the tracer changes.
#pragma once

#include <filesystem>

#include "tests/references/path_tracer.hpp"

namespace torolux::accuracy {

struct View {
  Camera camera;
  bool two_sided_lights = false;
};

/// Passes of 1, 1, 2, 4, ... times `first_samples` until the noise is low enough.
struct ReferenceEffort {
  std::uint32_t first_samples = 256;   ///< per pixel
  double noise = 0.004;                ///< as references::reference_noise has it
  std::uint32_t most_samples = 16384;  ///< per pixel, all passes; where the noise stays higher, so be it
};

/// From `folder`, or traced and written there. size: width and height.
references::TracedPicture reference_picture(const Scene& scene, const View& view,
                                            const std::array<std::uint32_t, 2>& size, const ReferenceEffort& effort,
                                            unsigned threads, const std::filesystem::path& folder);

}  // namespace torolux::accuracy
