// SPDX-License-Identifier: MIT
// The executable part of an image, decoded: an instruction with its cost at every even address, since a jump may go
// anywhere.
#pragma once

#include <cstdint>
#include <vector>

#include "emulator/description/description.hpp"
#include "emulator/engines/image/image.hpp"
#include "emulator/engines/translated/decode/instruction.hpp"
#include "emulator/engines/translated/semantics/pe_state.hpp"

namespace torolux::translated {

struct PlacedInstruction {
  Instruction instruction;
  Cost cost;
};

class CodeMap {
 public:
  CodeMap(const Image& image, const LatencyTable& latency);

  /// Nothing where no code is, or only the first half of an instruction.
  const PlacedInstruction* at(std::uint32_t address) const {
    const std::uint32_t index = (address - begin_) / 2;
    return address % 2 == 0 && index < instructions_.size() && instructions_[index].instruction.bytes != 0
               ? &instructions_[index]
               : nullptr;
  }
  /// Whether any byte of [address, address + bytes) belongs to a segment of code.
  bool holds_code(std::uint32_t address, std::uint32_t bytes) const;

  std::uint32_t begin() const { return begin_; }  ///< first address of code
  std::uint32_t end() const { return begin_ + static_cast<std::uint32_t>(2 * instructions_.size()); }
  /// Stores from here on never reach code.
  std::uint32_t store_base() const { return store_base_; }

 private:
  struct Span {
    std::uint32_t begin, end;
  };
  void decode_segment(const ImageSegment& segment, const LatencyTable& latency);

  std::uint32_t begin_ = 0;
  std::uint32_t store_base_ = 0;
  std::vector<PlacedInstruction> instructions_;  // bytes == 0: not code
  std::vector<Span> spans_;
};

}  // namespace torolux::translated
