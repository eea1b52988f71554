// SPDX-License-Identifier: MIT
// The calls that lead to where a PE stands. Enters: its image, its registers and its memory; leaves: one frame for each
// call, the innermost first, and the same in words. Neither image nor memory is believed: it always ends.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "emulator/engines/image/debug_info.hpp"
#include "emulator/engines/image/image.hpp"

namespace torolux {

struct CallFrame {
  std::uint32_t pc;   ///< innermost: of the instruction; else behind the call
  SourcePlace place;  ///< function: by the symbol table, where nothing else knows it
};

/// Most frames of a backtrace.
inline constexpr std::size_t kMostFrames = 32;

struct CallStack {
  std::vector<CallFrame> frames;  ///< at least one, at most kMostFrames
  bool whole = false;             ///< the last one is where the image begins
};

/// innermost: at least its pc is known.
CallStack call_stack(const Image& image, const DebugInfo& debug_info, const FrameRegisters& innermost,
                     const ReadWord& read);

/// A line for each, as "  #1 0x80000123 in compute(int) at main.cpp:12", each with a line end in front; a last line
/// "  ..." where there are more, or nobody knows.
std::string in_words(const CallStack& stack);

}  // namespace torolux
