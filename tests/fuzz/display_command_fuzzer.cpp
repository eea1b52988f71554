// SPDX-License-Identifier: MIT
// libFuzzer: any bytes as a command of the display's page in; no crash, and nothing but a refusal, out.
#include "tests/fuzz/load_display.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  torolux::obey_command(std::string(data, data + size));
  return 0;
}
