// SPDX-License-Identifier: MIT
// The memory of a machine's PEs before the start. Enter: set-up and images; leave: channels, local memories that hold
// the images, NIU windows filled in.
#pragma once

#include <span>
#include <vector>

#include "emulator/engines/engine/engine.hpp"
#include "emulator/engines/image/image_set.hpp"
#include "emulator/machine/machine.hpp"

namespace torolux {

struct PeMemories {
  SharedMemory channels;  ///< of the PEs that threads of this process run, all in one
  std::vector<PeMemory> pes;
};

/// numbers: of the PEs to make, in the order in which they leave; images: by place in that order. on_qemu: by number:
/// another process must be able to map it. Throws InputError where an image does not fit, MachineFailure where there is
/// no memory.
PeMemories make_pes(const MachineSetup& setup, const ImageSet& images, std::span<const unsigned> numbers,
                    const std::vector<bool>& on_qemu);

/// Of all PEs, which other ranks run: their local memories are not used, and take nearly none of this computer's.
/// Throws as make_pes would.
PeMemories mirrors_of(const MachineSetup& setup, const ImageSet& images);

}  // namespace torolux
