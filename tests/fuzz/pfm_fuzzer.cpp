// SPDX-License-Identifier: MIT
// libFuzzer: any bytes as a .pfm in; no crash, and a picture of the size that it says or a message, out.
#include <cstdlib>

#include "emulator/errors.hpp"
#include "host_tools/picture/formats.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  try {
    const torolux::Picture picture = torolux::decode_pfm(std::as_bytes(std::span(data, size)), "fuzz.pfm");
    if (picture.pixels.size() != std::size_t{picture.width} * picture.height) std::abort();
  } catch (const torolux::InputError&) {
  }
  return 0;
}
