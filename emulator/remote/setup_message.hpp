// SPDX-License-Identifier: MIT
// A machine's set-up enters; what a rank must know to make its PEs leaves, to a message's bytes and back.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "emulator/engines/image/image_set.hpp"
#include "emulator/machine/machine.hpp"

namespace torolux::remote {

/// Which PEs one rank has, and who has the others.
struct BlockPlace {
  std::vector<unsigned> numbers;     ///< of its PEs
  unsigned sharers = 1;              ///< ranks with PEs on the same computer, this one included
  std::vector<unsigned> rank_of;     ///< of each PE of the machine
  std::uint32_t machine_number = 0;  ///< of those that rank 0 makes, one after the other
};

/// The PEs of one rank.
struct BlockSetup {
  MachineSetup machine;  ///< what belongs to PEs and engine; nobody watches
  BlockPlace place;
  ImageSet images;  ///< by place in `place.numbers`
};

std::vector<std::byte> bytes_of_setup(const MachineSetup& machine, const ImageSet& images, const BlockPlace& place);
/// Throws InputError where these are other bytes.
BlockSetup setup_of_bytes(std::span<const std::byte> bytes);

}  // namespace torolux::remote
