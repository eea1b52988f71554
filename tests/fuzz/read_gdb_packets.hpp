// SPDX-License-Identifier: MIT
// What the fuzzer of the debugger's packets does with its bytes: cut them into packets, read each as every request.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include "emulator/debugger/packets.hpp"
#include "emulator/debugger/registers.hpp"
#include "emulator/debugger/requests.hpp"
#include "emulator/debugger/words.hpp"

namespace torolux {

/// True: there was a packet.
inline bool read_gdb_packets(const std::string& bytes) {
  debugger::PacketReader reader;
  reader.take(bytes);
  bool any = false;
  while (const auto item = reader.next()) {
    if (item->kind != debugger::PacketReader::Item::Kind::packet) continue;
    any = true;
    const std::string_view packet = item->contents;
    for (std::size_t begin = 0; begin <= std::min<std::size_t>(packet.size(), 8); ++begin) {
      const std::string_view rest = packet.substr(begin);
      debugger::resume_actions(rest);
      debugger::thread_choice(rest);
      debugger::memory_range(rest);
      debugger::point_in(rest);
      PeRegisters registers{};
      debugger::set_register(registers, 1, rest);
    }
    debugger::PacketReader again;
    again.take(debugger::framed(packet));
    const auto same = again.next();
    if (!same || same->contents != packet) __builtin_trap();
  }
  return any;
}

}  // namespace torolux
