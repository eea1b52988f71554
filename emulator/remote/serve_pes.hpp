// SPDX-License-Identifier: MIT
// The ranks beside rank 0: they run blocks of PEs for the machines that rank 0 makes, until it says that this is the
// end.
#pragma once

#include <string>

#include "emulator/ranks/life_signs.hpp"

namespace torolux::remote {

/// Closes the transport at the end. program: which build this is; all ranks must have the same. Where rank 0 falls
/// silent, all ranks are ended (Transport::abort). Writes no file and prints nothing.
void serve_pes(ranks::Transport& transport, const std::string& program, ranks::LifeTimes times = {});

}  // namespace torolux::remote
