// SPDX-License-Identifier: MIT
// Parts of local memories as files. Enter: places as the user names them, images; leave: checked places, then files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "emulator/machine/machine.hpp"

namespace torolux {

/// As the user names it.
struct DumpRequest {
  unsigned pe = 0;
  std::string place;                   ///< an address, decimal or hexadecimal with 0x, or a symbol of the PE's image
  std::optional<std::uint64_t> bytes;  ///< none: of a symbol with a size, that
  std::filesystem::path file;
};

/// "PE:PLACE:BYTES=FILE" or "PE:SYMBOL=FILE". BYTES as an address. Throws UsageError.
DumpRequest parse_dump(const std::string& text);

/// Inside the PE's local memory.
struct MemoryDump {
  unsigned pe;
  std::uint32_t offset;  ///< from the local memory's first byte
  std::uint32_t bytes;   ///< >= 1
  std::filesystem::path file;
};

/// Throws InputError: no such PE or symbol, a symbol without a size and no number of bytes, bytes outside local memory.
MemoryDump resolve_dump(const DumpRequest& request, const MachineSetup& setup, const ImageSet& images);

/// Of a machine whose run has ended, however. Throws InputError.
void write_dumps(const Machine& machine, const std::vector<MemoryDump>& dumps);

}  // namespace torolux
