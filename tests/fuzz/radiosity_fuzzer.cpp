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

/// libFuzzer's own changes, but of a valid file where it has none yet; every second one keeps the valid file's length.
/// Head, names of scene and settings, and length are not to be found by chance.
extern "C" std::size_t LLVMFuzzerMutate(unsigned char* data, std::size_t size, std::size_t most);
extern "C" std::size_t LLVMFuzzerCustomMutator(unsigned char* data, std::size_t size, std::size_t most, unsigned seed) {
  static const std::vector<std::byte> valid = torolux::RadiosityFuzz().valid_file();
  if (valid.size() > most) return LLVMFuzzerMutate(data, size, most);
  if (size < 104) {
    std::memcpy(data, valid.data(), valid.size());
    size = valid.size();
  }
  const std::size_t changed = LLVMFuzzerMutate(data, size, most);
  if (seed % 2 == 0) return changed;
  if (changed < valid.size()) std::memcpy(data + changed, valid.data() + changed, valid.size() - changed);
  return valid.size();
}
