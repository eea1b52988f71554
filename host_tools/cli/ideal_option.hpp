// SPDX-License-Identifier: MIT
// --ideal: names enter; which parts of a machine cost nothing, on top of its description, leaves.
#pragma once

#include <string>

#include "emulator/description/description.hpp"

namespace CLI {
class App;
}

namespace torolux {

/// Parts named with commas between them, or `all`, in a machine's description. Throws UsageError.
void make_ideal(const std::string& parts, MachineDescription::Ideal& ideal);

/// Sets what it names in `ideal`, which outlives the parsing.
void add_ideal_option(CLI::App& command, MachineDescription::Ideal& ideal, const std::string& group);

/// What either of them says.
MachineDescription::Ideal either(const MachineDescription::Ideal& a, const MachineDescription::Ideal& b);

}  // namespace torolux
