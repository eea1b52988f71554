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

/// From `folder`, or traced and written there.
references::TracedPicture reference_picture(const Scene& scene, const View& view, const references::TraceChoice& choice,
                                            const std::filesystem::path& folder);

}  // namespace torolux::accuracy
