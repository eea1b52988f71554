// SPDX-License-Identifier: MIT
// An option's text enters, its value leaves; errors name the option, which the parsers of parse_values.hpp do not.
#pragma once

#include <string>

#include "emulator/errors.hpp"

namespace torolux {

/// parse(text). Throws UsageError, InputError with "OPTION: " in front.
template <class Parse>
auto value_of(const std::string& option, Parse parse, const std::string& text) {
  try {
    return parse(text);
  } catch (const UsageError& error) {
    throw UsageError(option + ": " + error.what());
  } catch (const InputError& error) {
    throw InputError(option + ": " + error.what());
  }
}

}  // namespace torolux
