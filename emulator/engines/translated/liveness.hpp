// SPDX-License-Identifier: MIT
// Which registers may still be read: the others need not be kept. Instructions and blocks in, sets of registers out.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "emulator/engines/translated/blocks.hpp"

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

inline constexpr RegisterSet kFloatRegisters = ~RegisterSet{0} << 32U;
RegisterSet reads_of(const Instruction& i);
RegisterSet writes_of(const Instruction& i);
/// Whether it may trap, so that a handler sees the registers.
bool may_trap(const Instruction& i);
/// `ret`.
bool is_return(const Instruction& i);

/// Where an indirect jump goes, as far as anybody can tell.
enum class Reach : std::uint8_t {
  behind_calls,  ///< `ret`
  function,      ///< the function it stands in: a table of a `switch`
  entries,       ///< the function it stands in, where functions begin, and addresses that stand somewhere
  anywhere,
};
/// Programs without symbols of functions may jump anywhere.
Reach reach_of(const CodeMap& code, const Blocks& blocks, const Block& block);

/// Follows the flow of control through the whole program. That indirect jumps go where Reach says is checked when they
/// do (TranslatedImage).
class Liveness {
 public:
  Liveness(const CodeMap& code, const Blocks& blocks);

  /// Read from this address on before it is written; everything where no block begins.
  RegisterSet at(std::uint32_t address) const;
  /// Read behind the block's last instruction. A call: by what it calls, or behind it.
  RegisterSet behind(const Block& block) const;
  /// Before instruction i, if `behind` is read after it.
  RegisterSet before(const Instruction& i, RegisterSet behind) const {
    return (behind & ~writes_of(i)) | reads_of(i) | (may_trap(i) ? in_traps_ : 0);
  }
  /// Read by the trap handler.
  RegisterSet in_traps() const { return in_traps_; }

 private:
  void find_trap_handlers();
  RegisterSet behind_indirect(const Block& block) const;
  bool update();

  const CodeMap& code_;
  const Blocks& blocks_;
  std::map<std::uint32_t, RegisterSet> live_;
  std::set<std::uint32_t> trap_handlers_;
  bool foreign_trap_handler_ = false;  // the program computes its address in ways that are not understood
  RegisterSet in_traps_ = 0;
  RegisterSet behind_returns_ = 0;
  RegisterSet at_entries_ = 0;
  std::vector<RegisterSet> in_functions_;  // at any of its instructions
};

}  // namespace torolux::translated
