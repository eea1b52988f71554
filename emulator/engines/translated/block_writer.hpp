// SPDX-License-Identifier: MIT
// Writes the C++ text of instructions. Keeps track of which f registers hold a NaN that is not yet RISC-V's: results of
// the host's arithmetic are made canonical only where somebody could see the difference.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <string>

#include "emulator/engines/translated/code_map.hpp"

namespace torolux::translated {

/// Registers that a region reads or writes.
struct RegisterUse {
  std::bitset<32> x, f;  ///< read or written
  std::bitset<32> x_written, f_written;
};

class BlockWriter {
 public:
  /// observed: the program can see fflags and mstatus.FS.
  BlockWriter(const CodeMap& code, bool observed, std::string& out, RegisterUse& use)
      : code_(code), observed_(observed), out_(out), use_(use) {}

  /// cost_behind: of the rest of the block, for phase markers.
  void write(const Instruction& i, std::uint32_t pc, Cost cost_behind);
  /// Condition of a branch.
  std::string condition(const Instruction& i);
  /// Makes all results canonical: the block ends.
  void settle();

  /// A read of x register n, and of an f register as arithmetic may see it.
  std::string x(unsigned n);
  void line(const std::string& text);
  std::string assign_x(unsigned n);

 private:
  bool write_integer(const Instruction& i, std::uint32_t pc);
  bool write_memory(const Instruction& i, std::uint32_t pc);
  bool write_arithmetic(const Instruction& i);
  bool write_flagged(const Instruction& i);
  bool write_bits(const Instruction& i);
  void write_marker(const Instruction& i, std::uint32_t pc, Cost cost_behind);
  void write_load(const Instruction& i, std::uint32_t pc);
  void write_store(const Instruction& i, std::uint32_t pc);

  std::string f(unsigned n);
  std::string exact_f(unsigned n);  // settles it first
  std::string assign_f(unsigned n, bool settled);
  std::string look(std::uint32_t pc) const;
  std::string address(const Instruction& i, std::uint32_t base);

  const CodeMap& code_;
  bool observed_;
  std::string& out_;
  RegisterUse& use_;
  std::bitset<32> unsettled_;
};

/// 0x80000000u
std::string hexadecimal(std::uint32_t value);

}  // namespace torolux::translated
