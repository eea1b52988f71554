// SPDX-License-Identifier: MIT
// Faults of PEs in words: codes and details in, one line out.
#pragma once

#include <string>

#include "emulator/machine/call_stacks.hpp"
#include "emulator/niu/channel.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {

/// A program that has ended the run (Hint::fail), traps included; it may have left words of its own in local memory.
std::string describe_fault(unsigned pe, const protocol::Fault& fault, CallStacks& stacks);
/// A program that has used its NIU wrongly, or that would never again have used it.
std::string describe_fault(unsigned pe, const NiuFault& fault, CallStacks& stacks);
/// The calls that led there, one in a line; "": they cannot be told.
std::string calls_to(unsigned pe, const NiuFault& fault, CallStacks& stacks);

}  // namespace torolux
