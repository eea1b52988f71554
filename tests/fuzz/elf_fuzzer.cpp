// SPDX-License-Identifier: MIT
// libFuzzer: any bytes as a firmware image in; no crash, and a message with its file, out.
#include "tests/fuzz/load_machine.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  torolux::load_elf(std::as_bytes(std::span(data, size)));
  return 0;
}
