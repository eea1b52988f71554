// SPDX-License-Identifier: MIT
// A header, and the contents as they are.
#include "host_tools/display/messages.hpp"

#include <bit>

namespace torolux {

static_assert(std::endian::native == std::endian::little);

void append_message(std::string& out, MessageType type, std::string_view contents) {
  append_bytes(out, MessageHeader{static_cast<std::uint32_t>(type), static_cast<std::uint32_t>(contents.size())});
  out += contents;
}

}  // namespace torolux
