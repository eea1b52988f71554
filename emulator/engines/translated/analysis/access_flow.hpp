// SPDX-License-Identifier: MIT
// Which loads and stores of a function need a check whether they are plainly allowed: an earlier check by the same base
// register often covers them. Blocks in, checks by instruction out.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "emulator/engines/translated/analysis/blocks.hpp"

namespace torolux::translated {

/// Offsets from a base register, both inclusive; none where lowest > highest.
struct OffsetRange {
  std::int32_t lowest = 0, highest = -1;

  bool empty() const { return lowest > highest; }
  bool contains(std::int32_t offset) const { return offset >= lowest && offset <= highest; }
  bool operator==(const OffsetRange&) const = default;
};

/// Stands before the instruction and covers accesses of up to 4 bytes at all these offsets from its base register.
struct AccessCheck {
  bool stores;  ///< stores may go there, and so may loads
  OffsetRange offsets;
};
using AccessChecks = std::map<std::uint32_t, AccessCheck>;  ///< by the instruction's address

class AccessFlow {
 public:
  /// Where control goes from a block with registers kept, by the block's address.
  using Successors = std::map<std::uint32_t, std::vector<std::uint32_t>>;
  /// entered: those of the blocks that are also reached otherwise.
  AccessFlow(const CodeMap& code, const Blocks& blocks, const Successors& successors,
             const std::vector<std::uint32_t>& entered);

  /// Of one block. A check looks ahead: it covers later accesses too, so that these need none.
  const AccessChecks& checks(const Block& block) const { return checks_.at(block.begin); }

 private:
  struct Ranges {
    OffsetRange loads, stores;
    bool operator==(const Ranges&) const = default;
  };
  using ByBase = std::array<Ranges, 32>;
  /// A load or store, and what may still be accessed by the same base behind it.
  struct Step {
    const Instruction* instruction;
    std::uint32_t address;
    Ranges coming, coming_in_block;
  };
  struct AtBlock {
    std::vector<Step> steps;  ///< accesses, and what writes x registers
    ByBase coming{};          ///< may still be accessed, as the block begins
    ByBase known{};           ///< has been checked on every way to the block
    bool reached = false;     ///< `known` means something
  };

  std::vector<Step> steps_of(const CodeMap& code, const Block& block) const;
  ByBase coming_behind(const std::vector<std::uint32_t>& successors) const;
  bool update_coming(AtBlock& block, const std::vector<std::uint32_t>& successors);
  void note_coming(AtBlock& block, ByBase coming) const;
  bool update_known(AtBlock& block, const std::vector<std::uint32_t>& successors, bool widen);
  /// Goes through the block; what is known behind it leaves.
  static ByBase follow(const AtBlock& block, AccessChecks* checks);
  static AccessCheck check_for(const Step& step);

  std::map<std::uint32_t, AtBlock> at_;
  std::map<std::uint32_t, AccessChecks> checks_;
};

}  // namespace torolux::translated
