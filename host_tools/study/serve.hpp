// SPDX-License-Identifier: MIT
// The other ranks' side of a study on many: rank 0's orders enter, answers leave, until it says that this is the end.
#pragma once

#include <string>

#include "emulator/ranks/life_signs.hpp"
#include "host_tools/study/hands.hpp"

namespace torolux::study {

/// Closes the transport at the end. hands: do the orders; they bring results. program: this program's digest. Where
/// rank 0 falls silent, all ranks are ended (Transport::abort).
void serve(ranks::Transport& transport, Hands& hands, const std::string& program, ranks::LifeTimes times = {});

}  // namespace torolux::study
