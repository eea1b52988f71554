// SPDX-License-Identifier: MIT
// libFuzzer: any bytes as messages to a rank of a study in; no crash, and nothing but the end of all ranks, out.
#include "tests/fuzz/send_to_rank.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  torolux::send_to_rank(std::as_bytes(std::span(data, size)));
  return 0;
}
