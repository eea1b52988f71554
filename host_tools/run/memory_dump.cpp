// SPDX-License-Identifier: MIT
// Names into places, bytes into files.
#include "host_tools/run/memory_dump.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "emulator/engines/image/debug_info.hpp"
#include "emulator/errors.hpp"
#include "emulator/hexadecimal.hpp"
#include "emulator/nearest_name.hpp"
#include "firmware/protocol/machine.hpp"
#include "host_tools/files/write_file.hpp"

namespace torolux {
namespace {

/// Decimal, or hexadecimal behind 0x; nothing: it is no number, or a larger one than there are.
std::optional<std::uint64_t> number_in(std::string_view text) {
  const bool hexadecimal_form = text.starts_with("0x") || text.starts_with("0X");
  if (hexadecimal_form) text.remove_prefix(2);
  std::uint64_t value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value, hexadecimal_form ? 16 : 10);
  if (text.empty() || result.ec != std::errc() || result.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

[[noreturn]] void refuse(const std::string& why) {
  throw InputError("--dump: " + why);
}

/// By its name in the file or in the source.
const ImageSymbol& symbol_named(const std::string& name, const Image& image) {
  for (const ImageSymbol& symbol : image.symbols) {
    if (symbol.name == name || demangled(symbol.name) == name) return symbol;
  }
  std::vector<std::string> names;
  for (const ImageSymbol& symbol : image.symbols) names.push_back(demangled(symbol.name));
  refuse(image.file.string() + " has no symbol " + name + did_you_mean(name, names));
}

}  // namespace

DumpRequest parse_dump(const std::string& text) {
  const auto wrong = [&text]() {
    return UsageError("\"" + text + "\" is not of the form PE:ADDRESS:BYTES=FILE, PE:SYMBOL:BYTES=FILE or " +
                      "PE:SYMBOL=FILE");
  };
  const std::size_t colon = text.find(':');
  const std::size_t sign = text.find('=', colon == std::string::npos ? 0 : colon);
  if (colon == std::string::npos || sign == std::string::npos || sign + 1 == text.size()) throw wrong();
  DumpRequest request;
  const auto pe = number_in(std::string_view(text).substr(0, colon));
  if (!pe || *pe >= protocol::kMostPes) throw wrong();
  request.pe = static_cast<unsigned>(*pe);
  request.place = text.substr(colon + 1, sign - colon - 1);
  request.file = text.substr(sign + 1);
  // Names of C++ have colons, too.
  if (const std::size_t last = request.place.rfind(':'); last != std::string::npos) {
    request.bytes = number_in(std::string_view(request.place).substr(last + 1));
    if (request.bytes) request.place.resize(last);
  }
  if (request.place.empty() || (number_in(request.place) && !request.bytes)) throw wrong();
  return request;
}

MemoryDump resolve_dump(const DumpRequest& request, const MachineSetup& setup, const ImageSet& images) {
  const unsigned pes = setup.columns * setup.rows;
  if (request.pe >= pes)
    refuse("there is no PE " + std::to_string(request.pe) + "; the machine has 0 to " + std::to_string(pes - 1));
  std::uint64_t address = 0;
  std::uint64_t bytes = request.bytes.value_or(0);
  if (const auto number = number_in(request.place)) {
    address = *number;
  } else {
    const ImageSymbol& symbol = symbol_named(request.place, images.of(request.pe));
    address = symbol.address;
    bytes = request.bytes.value_or(symbol.bytes);
    if (!request.bytes && bytes == 0) refuse("the symbol " + request.place + " has no size: say how many bytes");
  }
  const std::uint64_t begin = protocol::kLocalMemoryBase;
  const std::uint64_t end = begin + setup.local_memory_bytes;
  if (bytes == 0 || address < begin || address >= end || bytes > end - address)
    refuse(std::to_string(bytes) + " bytes at " + request.place + ": a PE's local memory is " +
           hexadecimal(static_cast<std::uint32_t>(begin)) + " to " + hexadecimal(static_cast<std::uint32_t>(end - 1)) +
           ", and at least one byte of it is asked for");
  return {request.pe, static_cast<std::uint32_t>(address - begin), static_cast<std::uint32_t>(bytes), request.file};
}

void write_dumps(const Machine& machine, const std::vector<MemoryDump>& dumps) {
  for (const MemoryDump& dump : dumps)
    write_file(dump.file, machine.local_memory(dump.pe).subspan(dump.offset, dump.bytes));
}

}  // namespace torolux
