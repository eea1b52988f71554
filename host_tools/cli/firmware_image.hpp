// SPDX-License-Identifier: MIT
// Where the installed firmware is.
#pragma once

#include <filesystem>

namespace torolux {

/// pe.elf: in the environment variable TOROLUX_FIRMWARE (the image, or the folder that holds it), else
/// share/torolux/firmware of the installation, else where the builds put it. Throws InputError where there is none.
std::filesystem::path firmware_image();

}  // namespace torolux
