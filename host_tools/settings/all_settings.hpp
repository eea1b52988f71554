// SPDX-License-Identifier: MIT
// All that the table of options can set, as one value.
#pragma once

#include <type_traits>

#include "host_tools/picture/picture.hpp"
#include "host_tools/settings/machine_choice.hpp"
#include "host_tools/settings/quality.hpp"

namespace torolux {

struct AllSettings {
  Quality quality;
  ToneMapping tone;
  MachineChoice machine;
};

/// Quality, ToneMapping or MachineChoice of it.
template <class Part>
const Part& part_of(const AllSettings& settings) {
  if constexpr (std::is_same_v<Part, Quality>)
    return settings.quality;
  else if constexpr (std::is_same_v<Part, ToneMapping>)
    return settings.tone;
  else
    return settings.machine;
}
template <class Part>
Part& part_of(AllSettings& settings) {
  if constexpr (std::is_same_v<Part, Quality>)
    return settings.quality;
  else if constexpr (std::is_same_v<Part, ToneMapping>)
    return settings.tone;
  else
    return settings.machine;
}

}  // namespace torolux
