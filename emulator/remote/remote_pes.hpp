// SPDX-License-Identifier: MIT
// The engine of a machine whose PEs other ranks run: the scheduler meets mirrors of their channels here.
#pragma once

#include <memory>

#include "emulator/engines/engine/engine.hpp"
#include "emulator/machine/machine.hpp"

namespace torolux::remote {

class PeRanks;

/// Throws UsageError where the machine is to do what it can only with PEs of this process.
void check_goes_with_ranks(const MachineSetup& setup);

/// Sends each rank what it must know, and waits until all have made their PEs. pes: mirrors, which outlive the engine,
/// as `ranks` do. Throws RankFailure.
std::unique_ptr<Engine> make_remote_pes(PeRanks& ranks, const MachineSetup& setup, const ImageSet& images,
                                        std::vector<PeMemory>& pes);

}  // namespace torolux::remote
