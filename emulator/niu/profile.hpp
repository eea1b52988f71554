// SPDX-License-Identifier: MIT
// The profile of a PE: phase markers and stages enter, busy cycles by phase leave, and marks between stages. Part of
// the processor's side of a NIU.
#pragma once

#include <cstdint>

#include "emulator/niu/channel.hpp"

namespace torolux {

/// Charges the busy cycles since the last marker to the innermost open phase, then opens or closes one.
/// False: markers do not nest as they should; a fault has gone to the network side.
bool mark_phase(NiuChannel& channel, std::int32_t immediate, std::uint64_t clock);

/// All that the processor has done up to the end of the last HINT (or up to one that waits), open phases included. By
/// the processor's side, or while the processor waits.
ProcessorMark mark_of(const NiuChannel& channel);

/// The HINT that ends now, at channel.clock, has taken the first arrival of this stage.
void begin_stage(NiuChannel& channel, std::uint32_t stage);

}  // namespace torolux
