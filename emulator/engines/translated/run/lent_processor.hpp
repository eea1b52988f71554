// SPDX-License-Identifier: MIT
// A PE of the translated engine in a debugger's hands: a processor enters, what a debugger may do with it leaves.
#pragma once

#include <memory>

#include "emulator/engines/engine/pe_debugger.hpp"
#include "emulator/engines/translated/run/processor.hpp"

namespace torolux::translated {

/// The processor outlives it, and is run by nobody else.
std::unique_ptr<DebuggedPe> lend(Processor& processor);

}  // namespace torolux::translated
