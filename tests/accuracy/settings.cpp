// SPDX-License-Identifier: MIT
// The setting takes the place of --quality, and a scene's own numbers change with it in the same measure.
#include "tests/accuracy/settings.hpp"

#include "host_tools/cli/resolve.hpp"

namespace torolux::accuracy {

Quality quality_at(const Setting& setting, const Scene& scene) {
  RenderOptions options;
  options.preset = setting;
  return resolve(options, scene).quality;
}

}  // namespace torolux::accuracy
