// SPDX-License-Identifier: MIT
// See settings.hpp.
#include "tests/accuracy/settings.hpp"

namespace torolux::accuracy {

Quality quality_at(const Setting& setting, const Quality& settled) {
  Quality quality = settled;
  apply(setting, quality);
  if (quality.patch_length) *quality.patch_length *= setting.lengths;
  if (quality.element_length) *quality.element_length *= setting.lengths;
  return quality;
}

}  // namespace torolux::accuracy
