// SPDX-License-Identifier: MIT
// Registers of one function of the program: which of them differ from what memory holds, which local variables of the
// translated function are still needed. Blocks in, sets by block and instruction out.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "emulator/engines/translated/block_writer.hpp"
#include "emulator/engines/translated/generator.hpp"
#include "emulator/engines/translated/liveness.hpp"

namespace torolux::translated {

class FunctionFlow {
 public:
  FunctionFlow(const CodeMap& code, const Blocks& blocks, const Liveness& liveness, const GuestFunction& function);

  /// Written since they were loaded, as the block begins: to be saved on the way out if still read.
  RegisterSet dirty(std::uint32_t block) const { return at_.at(block).dirty; }
  /// Variables that are used before they are written, as the block begins.
  RegisterSet needed(std::uint32_t block) const { return at_.at(block).needed; }
  /// f registers that may hold another NaN than RISC-V's, as the block begins.
  RegisterSet unsettled(std::uint32_t block) const { return at_.at(block).unsettled; }
  /// To be saved if the interpreter goes on before each instruction of the block, then behind its last.
  std::vector<RegisterSet> saved(const Block& block) const;

  bool inside(std::uint32_t address) const { return at_.contains(address); }

 private:
  struct AtBlock {
    RegisterSet dirty = 0, needed = 0, unsettled = 0;
  };
  /// Blocks of this function that control reaches from this one with its variables kept.
  std::vector<std::uint32_t> successors(const Block& block) const;
  bool update_dirty(const Block& block);
  bool update_needed(const Block& block);
  bool update_unsettled(const Block& block);

  const CodeMap& code_;
  const Blocks& blocks_;
  const Liveness& liveness_;
  std::map<std::uint32_t, AtBlock> at_;
};

}  // namespace torolux::translated
