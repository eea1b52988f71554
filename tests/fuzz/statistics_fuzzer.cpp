// SPDX-License-Identifier: MIT
// libFuzzer: any bytes as statistics to be repeated in; no crash, and nothing but a refusal, out.
#include "tests/fuzz/load_study.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  torolux::load_statistics(std::string(data, data + size));
  return 0;
}
