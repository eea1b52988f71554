// SPDX-License-Identifier: MIT
// What main is to get. Enters: words of the command line; leaves: the image's object for them, filled in.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "emulator/engines/image/image.hpp"

namespace torolux {

/// arguments: argv[1] and what follows; argv[0] is the image's file name. local_memory: of a PE, the image loaded.
/// Throws UsageError: they are too long, or an image without main is to get some.
void write_arguments(const std::vector<std::string>& arguments, const Image& image, std::span<std::byte> local_memory);

}  // namespace torolux
