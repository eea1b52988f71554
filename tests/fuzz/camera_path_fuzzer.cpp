// SPDX-License-Identifier: MIT
// libFuzzer: any bytes as a path's cameras in; no crash, and nothing but a refusal, out.
#include "tests/fuzz/load_display.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  torolux::load_camera_path_text(std::string(data, data + size));
  return 0;
}
