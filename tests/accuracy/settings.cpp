// SPDX-License-Identifier: MIT
// See settings.hpp.
#include "tests/accuracy/settings.hpp"

#include <algorithm>

#include "host_tools/mesh/mesh.hpp"

namespace torolux::accuracy {

Quality quality_at(const Setting& setting, const Quality& settled, const Scene& scene) {
  Quality quality = settled;
  if (setting.length != 1) {
    const MeshLengths lengths =
        make_mesh(scene, {settled.patch_length, settled.element_length, settled.two_sided_lights}).lengths;
    quality.patch_length = lengths.patch * setting.length;
    quality.element_length = lengths.element * setting.length;
  }
  quality.hemicube = std::max(4U, settled.hemicube * setting.hemicube_percent / 200 * 2);
  if (setting.shot_points > 0) quality.shot_points = setting.shot_points;
  quality.unshot *= setting.unshot;
  quality.samples = std::max(1U, settled.samples * setting.samples_percent / 100);
  return quality;
}

}  // namespace torolux::accuracy
