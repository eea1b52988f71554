// SPDX-License-Identifier: MIT
// libFuzzer: any bytes as what a debugger sends in; no crash out.
#include "tests/fuzz/read_gdb_packets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  torolux::read_gdb_packets(std::string(data, data + size));
  return 0;
}
