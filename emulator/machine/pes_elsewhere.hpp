// SPDX-License-Identifier: MIT
// Whoever runs a machine's PEs in its place: a set-up enters, an engine leaves whose PEs are elsewhere.
#pragma once

#include <memory>
#include <vector>

#include "emulator/engines/engine/engine.hpp"
#include "emulator/engines/image/image_set.hpp"
#include "emulator/machine/machine.hpp"

namespace torolux {

class PesElsewhere {
 public:
  virtual ~PesElsewhere() = default;
  /// Throws UsageError where the machine is to do what it can only with PEs of this process.
  virtual void check(const MachineSetup& setup) const = 0;
  /// All PEs have been made when it returns. pes: of channels that nobody else uses; they outlive the engine, as this
  /// does. Throws MachineFailure.
  virtual std::unique_ptr<Engine> make_engine(const MachineSetup& setup, const ImageSet& images,
                                              std::vector<PeMemory>& pes) = 0;
};

}  // namespace torolux
