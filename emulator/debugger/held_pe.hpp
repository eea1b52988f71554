// SPDX-License-Identifier: MIT
// A PE that a debugger holds: one step of it, what stops it before, and what behind.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "emulator/debugger/requests.hpp"
#include "emulator/debugger/stop.hpp"
#include "emulator/engines/engine/pe_debugger.hpp"

namespace torolux::debugger {

/// Registers or memory that the debugger has set while the PE stood between two instructions.
struct Edit {
  std::uint64_t steps;                        ///< of the PE
  std::optional<PeRegisters> registers = {};  ///< all of them
  std::uint32_t address = 0;                  ///< of what has been written to memory
  std::vector<std::byte> bytes = {};
};

struct HeldPe {
  unsigned number;
  std::unique_ptr<DebuggedPe> pe = nullptr;  ///< null: the machine does not run
  std::uint64_t steps = 0;                   ///< instructions executed, HINTs and phase markers too
  Resumption resumption = {};
  bool left = false;  ///< the debugger has let go of it: it goes on like any other
  std::vector<Point> points = {};
  std::vector<Edit> edits = {};               ///< ascending by steps
  std::size_t edits_made = 0;                 ///< the first so many
  std::optional<std::uint64_t> told_at = {};  ///< steps at which the debugger has been told what comes next

  bool goes_on() const { return left || resumption.kind != Resumption::Kind::held; }
  bool stands_between() const { return pe->standing() == DebuggedPe::Standing::between; }
};

/// What has been set here the last time is set again.
void make_due_edits(HeldPe& held);
/// steps: at which it stands; edits up to there have been made.
void set_steps(HeldPe& held, std::uint64_t steps, bool edits_made_here);

/// Whether the instruction that comes next is one to stop at.
std::optional<Stop> stop_before(const HeldPe& held);

struct Stepped {
  DebuggedPe::Step how;
  std::optional<Stop> stop = {};  ///< a watchpoint, or a trap that has not happened
};
/// One instruction, or another try of the HINT in which it waits.
Stepped step(HeldPe& held, bool stops_at_trap);

}  // namespace torolux::debugger
