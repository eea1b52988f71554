// SPDX-License-Identifier: MIT
// Why held PEs have stopped, and how a debugger is told.
#pragma once

#include <cstdint>
#include <string>

#include "emulator/debugger/requests.hpp"

namespace torolux::debugger {

struct Stop {
  enum class Reason : std::uint8_t {
    attached,     ///< it stands, and has done nothing since it was asked
    breakpoint,   ///< before the instruction there
    watch,        ///< behind the instruction that has read or written; going back: before it
    step,         ///< behind the step
    interrupt,    ///< Ctrl-C
    trap,         ///< before an instruction that will trap: cause
    failure,      ///< before HINT `fail`
    cycle,        ///< of `monitor until`
    past_begins,  ///< gone back as far as there is anything
    held_back,    ///< what should go on waits for a PE that is held
  };
  Reason reason;
  unsigned pe;
  PointKind watch = PointKind::write;
  std::uint32_t address = 0;  ///< of the watchpoint
  std::uint32_t cause = 0;    ///< mcause, of a trap

  /// Before an instruction that has not been executed: it is not told of again when the PE goes on.
  bool is_before() const {
    return reason == Reason::breakpoint || reason == Reason::trap || reason == Reason::failure ||
           reason == Reason::cycle;
  }
};

/// "p3.1": PE 2.
std::string thread_name(unsigned pe);
/// A stop reply. knows_swbreak: whether the debugger has said so.
std::string stop_reply(const Stop& stop, bool knows_swbreak);

}  // namespace torolux::debugger
