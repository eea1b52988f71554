// SPDX-License-Identifier: MIT
// The profiles of all PEs of a machine. Enters: each PE's image; leaves: its profile, filled in while it runs.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <vector>

#include "emulator/engines/image/image.hpp"
#include "emulator/profile/function_table.hpp"
#include "emulator/profile/pe_profile.hpp"

namespace torolux::profile {

class CycleProfile {
 public:
  /// Forgets all; then `add` for each PE in turn. By the engine, before its PEs start.
  void begin(std::size_t pes);
  /// The next PE, which runs this image. It may be gone by the time that the profile is read.
  void add(const Image& image);

  std::size_t pes() const { return pes_.size(); }
  PeProfile& pe(std::size_t number) { return pes_[number]; }
  const PeProfile& pe(std::size_t number) const { return pes_[number]; }

 private:
  std::map<const Image*, std::unique_ptr<FunctionTable>> functions_;
  std::vector<PeProfile> pes_;
};

}  // namespace torolux::profile
