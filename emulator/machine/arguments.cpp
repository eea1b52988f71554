// SPDX-License-Identifier: MIT
// Words of the command line into an image's memory.
#include "emulator/machine/arguments.hpp"

#include <algorithm>
#include <cstring>

#include "emulator/errors.hpp"
#include "firmware/protocol/host_services.hpp"
#include "firmware/protocol/machine.hpp"

namespace torolux {

using protocol::Arguments;

void write_arguments(const std::vector<std::string>& arguments, const Image& image, std::span<std::byte> local_memory) {
  const auto symbol = std::ranges::find(image.symbols, protocol::kArgumentsSymbol, &ImageSymbol::name);
  if (symbol == image.symbols.end() || symbol->bytes != sizeof(Arguments)) {
    if (arguments.empty()) return;
    throw UsageError(image.file.string() + " has no main that could take arguments (what stands behind --): it has a " +
                     "pe_main of its own");
  }
  Arguments block{};
  std::string text = image.file.filename().string() + '\0';
  for (const std::string& argument : arguments) text += argument + '\0';
  if (text.size() > block.text.size()) {
    throw UsageError("the arguments behind -- have " + std::to_string(text.size()) + " bytes with the image's name; " +
                     std::to_string(block.text.size()) + " is the most: write them to a file and give it with --input");
  }
  block.count = static_cast<std::uint32_t>(arguments.size() + 1);
  block.bytes = static_cast<std::uint32_t>(text.size());
  std::ranges::copy(text, block.text.begin());
  const std::uint64_t offset = std::uint64_t{symbol->address} - protocol::kLocalMemoryBase;
  if (offset + sizeof block > local_memory.size()) {
    throw InputError(image.file.string() + ": its symbol " + std::string(protocol::kArgumentsSymbol) +
                     " lies outside local memory");
  }
  std::memcpy(local_memory.data() + offset, &block, sizeof block);
}

}  // namespace torolux
