// SPDX-License-Identifier: MIT
// The NIU's record slots as the processor's side sees them: which ones the program holds. Which slot an arrival gets
// depends on the PE's own operations alone.
#pragma once

#include <cstdint>
#include <optional>

#include "emulator/niu/channel.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {

/// All NIU slots free, numbered from slots.own. slots: checked by the caller.
void set_slot_list(ProcessorState& state, const protocol::NiuWindow::Slots& slots);

/// The program gives a NIU slot back. A fault where it is not one, or not the program's.
std::optional<NiuFault> release_slot(ProcessorState& state, std::uint32_t slot);

/// For a record that has come; the network side has made sure that there is one.
std::uint16_t take_slot(ProcessorState& state);

}  // namespace torolux
