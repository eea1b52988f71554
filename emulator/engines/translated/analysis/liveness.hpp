// SPDX-License-Identifier: MIT
// Which registers may still be read: the others need not be kept. Instructions and blocks in, sets of registers out.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "emulator/engines/engine/registers.hpp"
#include "emulator/engines/translated/analysis/blocks.hpp"

namespace torolux::translated {

/// Bits 1..31: x1..x31; 32..63: f0..f31.
using RegisterSet = std::uint64_t;
inline constexpr RegisterSet kAllRegisters = ~RegisterSet{1};

constexpr RegisterSet x_register(unsigned n) {
  return n == 0 ? 0 : RegisterSet{1} << n;
}
constexpr RegisterSet f_register(unsigned n) {
  return RegisterSet{1} << (32U + n);
}

/// By which calls are found where a PE stands (engine/registers.hpp).
inline constexpr RegisterSet kCallRegisters = kStackRegisters;

inline constexpr RegisterSet kFloatRegisters = ~RegisterSet{0} << 32U;
RegisterSet reads_of(const Instruction& i);
RegisterSet writes_of(const Instruction& i);
/// Whether it may trap, so that a handler sees the registers.
bool may_trap(const Instruction& i);
/// Whether it may set another trap handler.
bool may_write_mtvec(const Instruction& i);
/// `ret`.
bool is_return(const Instruction& i);

/// Follows the flow of control through the whole program. An indirect jump, `ret` too, may go to any instruction: all
/// registers are read behind it. So whatever it leads to, the registers there are the program's.
class Liveness {
 public:
  Liveness(const CodeMap& code, const Blocks& blocks);

  /// Read from this address on before it is written; everything where no block begins.
  RegisterSet at(std::uint32_t address) const;
  /// Read behind the block's last instruction. A call: by what it calls, or behind it. A PE may stand there: the
  /// registers by which calls are found are read, too.
  RegisterSet behind(const Block& block) const { return flows_on(block) | kCallRegisters; }
  /// Before instruction i, if `behind` is read after it.
  RegisterSet before(const Instruction& i, RegisterSet behind) const {
    if (may_write_mtvec(i)) return kAllRegisters;
    return (behind & ~writes_of(i)) | reads_of(i) | (may_trap(i) ? in_traps_ : 0);
  }
  /// Read by the trap handler.
  RegisterSet in_traps() const { return in_traps_; }
  /// Where traps may go; nothing: anywhere. With another handler translated code may not go on: it has not kept what
  /// that may read.
  std::optional<std::set<std::uint32_t>> trap_handlers() const {
    return foreign_trap_handler_ ? std::nullopt : std::optional(trap_handlers_);
  }

 private:
  void find_trap_handlers();
  bool update();
  RegisterSet flows_on(const Block& block) const;

  const CodeMap& code_;
  const Blocks& blocks_;
  std::map<std::uint32_t, RegisterSet> live_;
  std::set<std::uint32_t> trap_handlers_;
  bool foreign_trap_handler_ = false;  // the program computes its address in ways that are not understood
  RegisterSet in_traps_ = 0;
};

}  // namespace torolux::translated
