// SPDX-License-Identifier: MIT
// Where code of an image stands in its source. Enters: the image's file and an address; leaves: file and line in words.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace torolux {

/// "firmware/pe/pe.cpp:19", followed by ", inlined at ..." for each function that it became part of, the outermost
/// last. Asks binutils' riscv64-unknown-elf-addr2line, as every image of C++ has come from its neighbours; "" where
/// there is no such program, no such file, or nothing in it (compile with -g).
std::string source_line(const std::filesystem::path& image, std::uint32_t address);

}  // namespace torolux
