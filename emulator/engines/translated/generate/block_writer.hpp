// SPDX-License-Identifier: MIT
// Writes the C++ text of instructions. Keeps track of which f registers hold a NaN that is not yet RISC-V's: results of
// the host's arithmetic are made canonical only where somebody could see the difference.
#pragma once

#include <cstdint>
#include <string>

#include "emulator/engines/translated/analysis/access_flow.hpp"
#include "emulator/engines/translated/analysis/liveness.hpp"
#include "emulator/engines/translated/decode/code_map.hpp"

namespace torolux::translated {

class BlockWriter {
 public:
  /// observed: the program can see fflags and mstatus.FS.
  BlockWriter(const CodeMap& code, bool observed, std::string& out) : code_(code), observed_(observed), out_(out) {}

  /// Begins a block in which these f registers may hold a NaN that is not RISC-V's. checks: of its accesses.
  void begin(RegisterSet raw, const AccessChecks& checks);
  /// cost_behind: of the rest of the block, for phase markers. look: registers to be saved where it cannot go on.
  void write(const Instruction& i, std::uint32_t pc, Cost cost_behind, RegisterSet look);
  /// Whether the instruction may send the PE to the interpreter.
  bool may_look(std::uint32_t pc) const;
  /// Condition of a branch.
  std::string condition(const Instruction& i);
  /// Those that may hold a NaN that is not RISC-V's, as after `begin`.
  RegisterSet raw() const { return raw_; }
  void canonicalize(RegisterSet registers);

  /// Statements that leave with these registers saved. at: an expression, the address and why.
  std::string leave(RegisterSet save, const std::string& at) const;
  /// Statements that save registers.
  std::string save(RegisterSet registers) const;
  /// Statements that load registers.
  static std::string load(RegisterSet registers);

  static std::string x(unsigned n);
  static std::string assign_x(unsigned n);
  void line(const std::string& text);

 private:
  bool write_integer(const Instruction& i, std::uint32_t pc);
  bool write_memory(const Instruction& i, std::uint32_t pc, RegisterSet look);
  bool write_arithmetic(const Instruction& i);
  bool write_flagged(const Instruction& i);
  bool write_bits(const Instruction& i);
  void write_marker(const Instruction& i, std::uint32_t pc, Cost cost_behind, RegisterSet look);
  void write_check(const Instruction& i, std::uint32_t pc, RegisterSet look);

  static std::string f(unsigned n);
  std::string exact_f(unsigned n);  // canonicalizes it first
  std::string assign_f(unsigned n, bool canonical);
  std::string look(std::uint32_t pc, RegisterSet save) const;

  const CodeMap& code_;
  bool observed_;
  std::string& out_;
  RegisterSet raw_ = 0;
  AccessChecks checks_;
};

/// 0x80000000u
std::string hexadecimal(std::uint32_t value);

}  // namespace torolux::translated
