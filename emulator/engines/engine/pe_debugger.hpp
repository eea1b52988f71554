// SPDX-License-Identifier: MIT
// Where a debugger and an engine meet: the engine lends its PEs one instruction at a time, and asks whose turn it is.
// Knows no protocol; the debugger knows no engine.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "emulator/engines/engine/registers.hpp"
#include "emulator/snapshot/archive.hpp"

namespace torolux {

/// What an instruction is going to do to local memory: bytes [address, address + bytes).
struct MemoryAccess {
  std::uint32_t address;
  std::uint32_t bytes;  ///< 1, 2 or 4
  bool reads, writes;
};

/// A PE in a debugger's hands. For the scheduler's thread alone.
class DebuggedPe {
 public:
  virtual ~DebuggedPe() = default;

  enum class Standing : std::uint8_t {
    between,  ///< two instructions
    waits,    ///< in a HINT, for the network
    ended,    ///< it executes nothing more
  };
  virtual Standing standing() const = 0;

  enum class Step : std::uint8_t {
    done,   ///< an instruction has been executed, a HINT has happened
    traps,  ///< nothing has changed: the next instruction will trap
    waits,  ///< in a HINT which has no answer yet; the next step asks again
    ended,  ///< the HINT has happened, or failed, and nothing follows
  };
  /// stops_at_trap: false: an instruction that traps does so, and is done.
  virtual Step step(bool stops_at_trap) = 0;

  /// [cycles], of the instructions so far; of a HINT that waits, its own cost included.
  virtual std::uint64_t clock() const = 0;
  /// Of the next instruction, or of the HINT in which the PE waits.
  virtual std::uint32_t pc() const = 0;
  /// pc: as above.
  virtual PeRegisters registers() const = 0;
  /// While it stands between two instructions. Clock and instructions are left as they are.
  virtual void set_registers(const PeRegisters& registers) = 0;
  virtual std::span<std::byte> memory() = 0;
  /// Whether any byte of [address, address + bytes) is code, which cannot change.
  virtual bool is_code(std::uint32_t address, std::uint32_t bytes) const = 0;
  /// What the next instruction does to memory, if it is a load, a store or an atomic one.
  virtual std::optional<MemoryAccess> next_access() const = 0;
  /// Its immediate, if it is a HINT.
  virtual std::optional<std::int32_t> next_hint() const = 0;
  /// mcause, if the last step has said `traps`.
  virtual std::uint32_t trap_cause() const = 0;
};

/// Who holds PEs. Called from the scheduler's thread; may take any time, which nobody in the machine notices. Throws
/// what ends the run.
class PeDebugger {
 public:
  virtual ~PeDebugger() = default;
  /// By number of the PE: whether it is this debugger's.
  virtual bool holds(unsigned pe) const = 0;
  /// The machine begins. by_number: null where it does not hold the PE. They live until `end`.
  virtual void begin(std::vector<std::unique_ptr<DebuggedPe>> by_number) = 0;
  /// The PE has its turn: whatever comes before its clock has happened, and nothing else can before it has gone on. To
  /// be run while its clock is less than `until`, one step at least, if the debugger lets it.
  virtual void turn(unsigned pe, std::uint64_t until) = 0;
  /// Now and then, while the machine runs.
  virtual void look() = 0;
  /// The PEs are gone.
  virtual void end() = 0;

  // ---- Going back ----

  /// Writes all of the machine and the host's program, as it stands in `turn`.
  using Save = std::function<void(SnapshotWriter&)>;
  /// null: that cannot be done.
  virtual void may_save(Save save) = 0;
};

}  // namespace torolux
