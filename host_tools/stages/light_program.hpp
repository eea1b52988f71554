// SPDX-License-Identifier: MIT
// What all programs of the host have in common whose PEs send each other light: the kinds of records.
#pragma once

#include "emulator/host/host_program.hpp"
#include "emulator/torus/kind_rules.hpp"

namespace torolux {

class LightProgram : public HostProgram, public HasKindRules {
 public:
  /// Those of the radiosity stage, then those of the ray tracing stage.
  std::span<const std::string_view> record_kinds() const override;
  std::size_t record_kind(std::span<const std::byte> record) const override;
  std::span<const KindRule> kind_rules() const override;
};

}  // namespace torolux
