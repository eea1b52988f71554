// SPDX-License-Identifier: MIT
// libFuzzer: any bytes as messages to the host of `torolux run` in; no crash, and nothing but a failure of the run,
// out.
#include "tests/fuzz/send_to_listener.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  torolux::send_to_listener(std::as_bytes(std::span(data, size)));
  return 0;
}
