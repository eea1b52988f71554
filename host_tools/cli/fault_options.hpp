// SPDX-License-Identifier: MIT
// --jitter and --fault: what is made to go wrong in a machine, on top of its description.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "emulator/description/description.hpp"

namespace CLI {
class App;
}

namespace torolux {

struct FaultOptions {
  std::optional<std::uint32_t> jitter;  ///< seed
  std::optional<double> link_error_rate;

  void apply_to(MachineDescription& machine) const;
};

void add_fault_options(CLI::App& command, FaultOptions& options, const std::string& group);

}  // namespace torolux
