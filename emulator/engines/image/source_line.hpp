// SPDX-License-Identifier: MIT
// Where code of an image stands in its source. Enters: the image's debug information and an address; leaves: file and
// line in words.
#pragma once

#include <cstdint>
#include <string>

#include "emulator/engines/image/debug_info.hpp"

namespace torolux {

/// "firmware/pe/pe.cpp:19", followed by ", inlined at ..." for each function that it became part of, the outermost
/// last; "" where nothing is known (compile with -g).
std::string source_line(const DebugInfo& debug_info, std::uint32_t address);

}  // namespace torolux
