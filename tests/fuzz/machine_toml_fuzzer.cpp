// SPDX-License-Identifier: MIT
// libFuzzer: any bytes as a machine file in; no crash, and a message with its place, out.
#include "tests/fuzz/load_machine.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  torolux::load_machine_toml(std::string(data, data + size));
  return 0;
}
