// SPDX-License-Identifier: MIT
// How a PE got to its next HINT, one instruction at a time. Enters: its state after a HINT; leaves: the last
// instructions, the last store to a place, and what the interpreter makes of it all: a third opinion.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "emulator/engines/translated/decode/code_map.hpp"
#include "emulator/engines/translated/semantics/pe_state.hpp"

namespace torolux::lockstep {

struct TracedInstruction {
  std::uint32_t pc;
  std::uint64_t clock;  ///< behind it
  translated::Instruction instruction;
};

struct TracedStore {
  std::uint32_t pc;
  std::uint64_t clock;  ///< behind it
  std::uint32_t word;   ///< at the place, behind it
};

struct Trace {
  static constexpr std::size_t kMostKept = 30;

  std::deque<TracedInstruction> last;
  std::uint64_t instructions = 0;    ///< in all
  std::optional<TracedStore> store;  ///< the last that changed the word in question, or wrote it anew
  bool at_hint = false;              ///< else: stuck, or beyond the limit
};

struct TraceLimit {
  std::uint64_t instructions;
  std::uint64_t clock = ~std::uint64_t{0};
};

/// Interprets until the next HINT that is no phase marker, or the limit. watched: address of a word, a multiple of 4.
Trace trace_to_hint(const translated::CodeMap& code, translated::TranslatedPe& pe, std::optional<std::uint32_t> watched,
                    TraceLimit limit);

}  // namespace torolux::lockstep
