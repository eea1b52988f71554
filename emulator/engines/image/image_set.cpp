// SPDX-License-Identifier: MIT
// Images with names of their own for phases, seen as one machine.
#include "emulator/engines/image/image_set.hpp"

#include <algorithm>
#include <string>

namespace torolux {

PhaseNames ImageSet::phase_names() const {
  PhaseNames joined;
  for (std::size_t phase = 0; phase < joined.size(); ++phase) {
    std::vector<std::string> names;
    for (const Image& image : images_) {
      const std::string& name = image.phase_names[phase];
      if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : " / ") + name;
    const bool taken = !all.empty() && std::find(joined.begin(), joined.begin() + static_cast<std::ptrdiff_t>(phase),
                                                 all) != joined.begin() + static_cast<std::ptrdiff_t>(phase);
    joined[phase] = taken ? all + " (phase " + std::to_string(phase) + ")" : all;
  }
  return joined;
}

}  // namespace torolux
