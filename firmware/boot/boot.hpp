// SPDX-License-Identifier: MIT
// What start-up code and program owe each other: the program defines pe_main, start-up calls it with the NIU ready.
#pragma once

#include "firmware/niu/niu.hpp"

namespace torolux::pe {

/// The program. Called once, on the image's stack (linker/pe.ld says how large). When it returns, the PE halts.
/// Objects with static storage must be initialised at compile time (constinit) or be left zero.
void pe_main(Niu& niu);

}  // namespace torolux::pe
