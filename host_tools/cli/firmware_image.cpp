// SPDX-License-Identifier: MIT
// The executable's place and the environment enter, the path of pe.elf leaves.
#include "host_tools/cli/firmware_image.hpp"

#include <cstdlib>
#include <string>
#include <system_error>

#include "emulator/errors.hpp"
#include "emulator/installed_file.hpp"

namespace torolux {

std::filesystem::path firmware_image() {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path image;
  if (const char* named = std::getenv("TOROLUX_FIRMWARE"); named != nullptr && *named != '\0') {
    image = named;
    if (fs::is_directory(image, error)) image /= "pe.elf";
  } else {
    image = installed_file("share/torolux/firmware/pe.elf", "../../firmware/bin/pe.elf");
  }
  if (!fs::is_regular_file(image, error))
    throw InputError(image.string() +
                     ": no firmware image there; build it (./torolux does, or cmake --build --preset firmware), or "
                     "name it in TOROLUX_FIRMWARE");
  return image;
}

}  // namespace torolux
