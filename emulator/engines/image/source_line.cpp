// SPDX-License-Identifier: MIT
// The places of an address, in one line.
#include "emulator/engines/image/source_line.hpp"

namespace torolux {

std::string source_line(const DebugInfo& debug_info, std::uint32_t address) {
  std::string text;
  for (const SourcePlace& place : debug_info.places(address)) {
    if (place.file.empty() || place.line == 0) break;
    text += (text.empty() ? "" : ", inlined at ") + place.file + ":" + std::to_string(place.line);
  }
  return text;
}

}  // namespace torolux
