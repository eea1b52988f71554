// SPDX-License-Identifier: MIT
// Divides the blocks among the functions of the program.
#include "emulator/engines/translated/generate/generator.hpp"

namespace torolux::translated {

std::vector<GuestFunction> make_functions(const CodeMap& code, Blocks& blocks) {
  std::vector<GuestFunction> functions;
  for (std::size_t n = 0; n < blocks.functions().size(); ++n) {
    const std::uint32_t begin = blocks.functions()[n];
    const std::uint32_t first = n == 0 ? code.begin() : begin;
    const std::uint32_t end = n + 1 < blocks.functions().size() ? blocks.functions()[n + 1] : code.end();
    functions.push_back({begin, first, end - first, {}});
  }
  for (const auto& [address, block] : blocks.all()) functions[blocks.function_of(address)].blocks.push_back(address);
  std::vector<std::uint32_t> entries;
  for (const auto& [address, block] : blocks.all()) {
    for (const std::uint32_t to : {block.target, block.end}) {
      if (blocks.all().contains(to) && blocks.function_of(to) != blocks.function_of(address)) entries.push_back(to);
    }
  }
  for (const std::uint32_t entry : entries) blocks.make_entry(entry);
  return functions;
}

}  // namespace torolux::translated
