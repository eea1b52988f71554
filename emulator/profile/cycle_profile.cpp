// SPDX-License-Identifier: MIT
// PEs of one image share what is known of its functions.
#include "emulator/profile/cycle_profile.hpp"

namespace torolux::profile {

void CycleProfile::begin(std::size_t pes) {
  pes_.clear();
  functions_.clear();
  pes_.reserve(pes);
}

void CycleProfile::add(const Image& image) {
  std::unique_ptr<FunctionTable>& functions = functions_[&image];
  if (functions == nullptr) functions = std::make_unique<FunctionTable>(image);
  pes_.emplace_back(*functions);
}

}  // namespace torolux::profile
