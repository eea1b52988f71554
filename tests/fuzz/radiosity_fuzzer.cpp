// SPDX-License-Identifier: MIT
// libFuzzer: any bytes as a radiosity file in; no crash, and a message with its file, out. An empty input stands for a
// whole file, so that a run without a corpus begins with one that is taken.
#include "tests/fuzz/load_radiosity.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  static const torolux::RadiosityFuzz fuzz;
  if (size == 0) {
    if (!fuzz.read(fuzz.valid_file())) __builtin_trap();
  } else {
    fuzz.read(std::as_bytes(std::span(data, size)));
  }
  return 0;
}

/// libFuzzer's own changes, but of a valid file where it has none: the head and the names of scene and settings (104
/// bytes) are not to be found by chance.
extern "C" std::size_t LLVMFuzzerMutate(unsigned char* data, std::size_t size, std::size_t most);
extern "C" std::size_t LLVMFuzzerCustomMutator(unsigned char* data, std::size_t size, std::size_t most, unsigned) {
  static const std::vector<std::byte> valid = torolux::RadiosityFuzz().valid_file();
  if (size < 104 && valid.size() <= most) {
    std::memcpy(data, valid.data(), valid.size());
    size = valid.size();
  }
  return LLVMFuzzerMutate(data, size, most);
}
