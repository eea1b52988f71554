// SPDX-License-Identifier: MIT
// What all programs of the host have in common whose PEs send each other light: the kinds of records.
#pragma once

#include "emulator/host/host_program.hpp"

namespace torolux {

class LightProgram : public HostProgram {
 public:
  /// Those of the radiosity stage, then those of the ray tracing stage.
  std::span<const std::string_view> record_kinds() const override;
  /// Throws MachineFailure where no kind has that size.
  std::size_t record_kind(std::span<const std::byte> record) const override;
};

}  // namespace torolux
