// SPDX-License-Identifier: MIT
// Registers of one function of the program: which of them differ from what memory holds, which local variables of the
// translated function are still needed. Blocks in, sets by block and instruction out.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "emulator/engines/translated/analysis/access_flow.hpp"
#include "emulator/engines/translated/analysis/liveness.hpp"
#include "emulator/engines/translated/generate/block_writer.hpp"
#include "emulator/engines/translated/generate/generator.hpp"

namespace torolux::translated {

class FunctionFlow {
 public:
  /// resumes: as it can be entered in the middle, not only where it begins (generate).
  FunctionFlow(const CodeMap& code, const Blocks& blocks, const Liveness& liveness, const GuestFunction& function,
               bool resumes);

  /// Whether the block is reached from outside the function.
  bool is_entry(const Block& block) const {
    return resumes_ ? block.entry : block.begin == function_.begin || block.taken;
  }
  const AccessChecks& checks(const Block& block) const { return accesses_.checks(block); }

  /// Written since they were loaded, as the block begins: to be saved on the way out if still read.
  RegisterSet dirty(std::uint32_t block) const { return at_.at(block).dirty; }
  /// Variables that are used before they are written, as the block begins.
  RegisterSet needed(std::uint32_t block) const { return at_.at(block).needed; }
  /// f registers that were computed, on every way to the block, and so may hold another NaN than RISC-V's. What came
  /// from memory on some way is none of these: its bits stay as they are, whatever they mean.
  RegisterSet raw(std::uint32_t block) const { return at_.at(block).raw; }
  /// Of these at its end, those that must be canonical there, as some way on takes them for canonical.
  RegisterSet to_canonicalize(const Block& block, RegisterSet raw) const;
  /// To be saved if the interpreter goes on before each instruction of the block, then behind its last.
  std::vector<RegisterSet> saved(const Block& block) const;

  bool inside(std::uint32_t address) const { return at_.contains(address); }

 private:
  struct AtBlock {
    RegisterSet dirty = 0, needed = 0, raw = 0;
  };
  /// Blocks of this function that control reaches from this one with its variables kept.
  std::vector<std::uint32_t> successors(const Block& block) const;
  AccessFlow access_flow() const;
  bool update_dirty(const Block& block);
  bool update_needed(const Block& block);
  bool update_raw(const Block& block);
  /// Where variables come from memory: blocks reached from outside, and those behind calls.
  std::vector<std::uint32_t> entered() const;

  const CodeMap& code_;
  const Blocks& blocks_;
  const Liveness& liveness_;
  const GuestFunction& function_;
  bool resumes_;
  std::map<std::uint32_t, AtBlock> at_;
  AccessFlow accesses_;
};

}  // namespace torolux::translated
