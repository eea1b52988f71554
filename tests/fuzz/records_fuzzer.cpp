// SPDX-License-Identifier: MIT
// libFuzzer: any bytes as records and messages to a PE in; no crash, and nothing but a failure of the run, out.
#include "tests/fuzz/send_messages.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  torolux::send_to_pe(std::as_bytes(std::span(data, size)));
  return 0;
}
