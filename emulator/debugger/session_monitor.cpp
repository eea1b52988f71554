// SPDX-License-Identifier: MIT
// GDB's `monitor`: what only this machine has.
#include <algorithm>
#include <charconv>

#include "emulator/debugger/session.hpp"
#include "emulator/debugger/words.hpp"

namespace torolux::debugger {
namespace {

constexpr const char* kHelp =
    "monitor clock        cycles and instructions of the chosen PE\n"
    "monitor pes          where each PE stands\n"
    "monitor until CYCLE  what goes on next stops at the first instruction at this cycle or later\n";

const char* standing_of(const HeldPe& held) {
  switch (held.pe->standing()) {
    case DebuggedPe::Standing::between:
      return "may go on";
    case DebuggedPe::Standing::waits:
      return "waits in a HINT";
    case DebuggedPe::Standing::ended:
      return "has halted";
  }
  return "";
}

}  // namespace

std::string Session::tell_clock() {
  const HeldPe* const held = chosen();
  if (held == nullptr) return "the run has ended\n";
  return "PE " + std::to_string(chosen_) + ": cycle " + std::to_string(held->pe->clock()) + ", " +
         std::to_string(held->pe->registers().instructions) + " instructions\n";
}

std::string Session::tell_pes() const {
  std::string text;
  for (const HeldPe& held : execution_.pes()) {
    if (held.pe == nullptr) continue;
    text += "PE " + std::to_string(held.number) + ": cycle " + std::to_string(held.pe->clock()) + ", pc 0x" +
            hex(held.pe->pc()) + ", " + standing_of(held) + (held.left ? ", detached" : "") + "\n";
  }
  return text;
}

std::string Session::monitor(std::string_view command) {
  constexpr std::string_view kUntil = "until ";
  if (command == "clock") return hex_of(tell_clock());
  if (command == "pes") return hex_of(tell_pes());
  if (!command.starts_with(kUntil)) return hex_of(std::string_view(kHelp));
  command.remove_prefix(kUntil.size());
  std::uint64_t cycle = 0;
  const auto [end, error] = std::from_chars(command.data(), command.data() + command.size(), cycle);
  if (error != std::errc() || end != command.data() + command.size()) {
    return hex_of("monitor until CYCLE: a whole number of cycles\n");
  }
  execution_.stop_at(cycle);
  return hex_of("continue will stop at cycle " + std::to_string(cycle) + "\n");
}

}  // namespace torolux::debugger
