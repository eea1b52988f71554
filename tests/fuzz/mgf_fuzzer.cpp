// SPDX-License-Identifier: MIT
// libFuzzer: any bytes as an MGF file in; no crash, and a message with its place, out.
#include "tests/fuzz/load_text.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  torolux::load_mgf(std::string(data, data + size), size % 2 == 1);
  return 0;
}
