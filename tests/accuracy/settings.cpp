// SPDX-License-Identifier: MIT
// See settings.hpp.
#include "tests/accuracy/settings.hpp"

#include "host_tools/cli/settle.hpp"

namespace torolux::accuracy {

Quality quality_at(const Setting& setting, const Scene& scene) {
  RenderOptions options;
  options.preset = setting;
  return settle(options, scene).quality;
}

}  // namespace torolux::accuracy
