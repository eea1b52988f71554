// SPDX-License-Identifier: MIT
// What was given, over other settings.
#include "host_tools/settings/given_settings.hpp"

namespace torolux {

void GivenSettings::apply_to(AllSettings& settings) const {
  for (const Option& option : all_options()) {
    if (has(option)) copy_value(option, values_, settings);
  }
}

}  // namespace torolux
