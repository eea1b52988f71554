// SPDX-License-Identifier: MIT
// "T", a signal, and what more there is to say.
#include "emulator/debugger/stop.hpp"

#include "emulator/debugger/words.hpp"

namespace torolux::debugger {
namespace {

/// As GDB numbers them.
constexpr unsigned kSigInt = 2, kSigIll = 4, kSigTrap = 5, kSigAbrt = 6, kSigBus = 10, kSigSegv = 11;

unsigned signal_of_cause(std::uint32_t cause) {
  constexpr std::uint32_t kIllegal = 2, kBreakpoint = 3, kLoadMisaligned = 4, kStoreMisaligned = 6;
  switch (cause) {
    case kIllegal:
      return kSigIll;
    case kBreakpoint:
      return kSigTrap;
    case kLoadMisaligned:
    case kStoreMisaligned:
      return kSigBus;
    default:
      return kSigSegv;
  }
}

unsigned signal_of(const Stop& stop) {
  switch (stop.reason) {
    case Stop::Reason::interrupt:
      return kSigInt;
    case Stop::Reason::failure:
      return kSigAbrt;
    case Stop::Reason::trap:
      return signal_of_cause(stop.cause);
    default:
      return kSigTrap;
  }
}

std::string_view watch_name(PointKind kind) {
  return kind == PointKind::read ? "rwatch" : kind == PointKind::access ? "awatch" : "watch";
}

}  // namespace

std::string thread_name(unsigned pe) {
  return "p" + hex(pe + 1) + ".1";
}

std::string stop_reply(const Stop& stop, bool knows_swbreak) {
  constexpr unsigned kSixteen = 16;
  const unsigned signal = signal_of(stop);
  std::string reply = "T" + hex(signal / kSixteen) + hex(signal % kSixteen) + "thread:" + thread_name(stop.pe) + ";";
  if (stop.reason == Stop::Reason::breakpoint && knows_swbreak) reply += "swbreak:;";
  if (stop.reason == Stop::Reason::watch) reply += std::string(watch_name(stop.watch)) + ":" + hex(stop.address) + ";";
  if (stop.reason == Stop::Reason::past_begins) reply += "replaylog:begin;";
  return reply;
}

}  // namespace torolux::debugger
