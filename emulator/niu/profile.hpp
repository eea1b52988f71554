// SPDX-License-Identifier: MIT
// The profile of a PE: phase markers enter, busy cycles by phase leave. Part of the processor's side of a NIU.
#pragma once

#include <cstdint>

#include "emulator/niu/channel.hpp"

namespace torolux {

/// Charges the busy cycles since the last marker to the innermost open phase, then opens or closes one.
/// False: markers do not nest as they should; a fault has gone to the network side.
bool mark_phase(NiuChannel& channel, std::int32_t immediate, std::uint64_t clock);

}  // namespace torolux
