// SPDX-License-Identifier: MIT
// Faults of PEs in words: codes and details in, one line out.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "emulator/engines/image/image.hpp"
#include "emulator/niu/channel.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {

/// A program that has ended the run (Hint::fail), traps included. local_memory: of that PE, for what it says itself.
std::string describe_fault(unsigned pe, const protocol::Fault& fault, const Image& image,
                           std::span<const std::byte> local_memory);
/// A program that has used its NIU wrongly, or that would never again have used it.
std::string describe_fault(unsigned pe, const NiuFault& fault, const Image& image);

}  // namespace torolux
