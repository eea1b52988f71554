// SPDX-License-Identifier: MIT
// From frame to frame, by debug information where there is some, else by how functions begin.
#include "emulator/engines/image/backtrace.hpp"

#include <algorithm>

#include "emulator/engines/image/prologue.hpp"
#include "emulator/hexadecimal.hpp"

namespace torolux {
namespace {

bool is_code(const Image& image, std::uint32_t address) {
  return std::ranges::any_of(image.segments, [address](const ImageSegment& segment) {
    return segment.executable && address >= segment.address && address - segment.address < segment.contents.size();
  });
}

/// Of a function without debug information, from its first instructions.
std::optional<FrameRegisters> caller_by_prologue(const Image& image, const FrameRegisters& frame, std::uint32_t address,
                                                 bool innermost, const ReadWord& read) {
  FrameRegisters caller = frame;
  if (is_code(image, address)) {
    const ImageSymbol* function = image.symbol_of(address);
    const auto layout = function != nullptr ? frame_layout(image, function->address, address) : std::nullopt;
    if (!layout || !frame.stack_pointer()) return std::nullopt;
    // Who has called keeps the way back in memory.
    if (!innermost && !layout->saved[1]) return std::nullopt;
    const std::uint32_t base = *frame.stack_pointer() + layout->bytes;
    for (std::size_t number = 0; number < caller.x.size(); ++number) {
      if (const auto& place = layout->saved[number]) caller.x[number] = read(base + static_cast<std::uint32_t>(*place));
    }
    caller.x[2] = base;
  } else if (!innermost) {
    return std::nullopt;
  }  // else nothing has begun where it jumped to
  if (!caller.return_address()) return std::nullopt;
  caller.pc = *caller.return_address();
  return caller;
}

/// The symbol alone.
std::string symbol_name(const Image& image, std::uint32_t address) {
  const std::string text = image.describe(address);
  return text.substr(0, text.rfind("+0x"));
}

}  // namespace

CallStack call_stack(const Image& image, const DebugInfo& debug_info, const FrameRegisters& innermost,
                     const ReadWord& read) {
  CallStack stack;
  const ImageSymbol* const first = image.symbol_of(image.entry);
  FrameRegisters frame = innermost;
  while (stack.frames.size() < kMostFrames) {
    const bool is_innermost = stack.frames.empty();
    const std::uint32_t address = frame.pc - (is_innermost ? 0 : 1);  // of the call, not of what follows it
    std::vector<SourcePlace> places = debug_info.places(address);
    if (places.empty()) places.emplace_back();
    // The symbol has the arguments of a static function, too.
    if (is_code(image, address) && image.symbol_of(address) != nullptr) places.back().function.clear();
    for (SourcePlace& place : places) {
      if (place.function.empty()) place.function = symbol_name(image, address);
      if (stack.frames.size() < kMostFrames) stack.frames.push_back({frame.pc, std::move(place)});
    }
    if (is_code(image, address) && image.symbol_of(address) == first) {
      stack.whole = true;
      break;
    }
    const auto caller = debug_info.knows_frame(address) ? debug_info.caller(frame, address, read)
                                                        : caller_by_prologue(image, frame, address, is_innermost, read);
    if (!caller || !is_code(image, caller->pc - 1) || !caller->stack_pointer()) break;
    // A stack grows down: who has called is above, or it is the innermost alone that has no frame of its own.
    const bool above = frame.stack_pointer() && *caller->stack_pointer() > *frame.stack_pointer();
    const bool beside = is_innermost && caller->stack_pointer() == frame.stack_pointer();
    if (!above && !beside) break;
    frame = *caller;
  }
  return stack;
}

std::string in_words(const CallStack& stack) {
  std::string text;
  for (std::size_t i = 0; i < stack.frames.size(); ++i) {
    const auto& [pc, place] = stack.frames[i];
    text += "\n  #" + std::to_string(i) + " " + hexadecimal(pc) + " in " + place.function;
    if (!place.file.empty()) text += " at " + place.file + ":" + std::to_string(place.line);
  }
  return stack.whole ? text : text + "\n  ...";
}

}  // namespace torolux
