// SPDX-License-Identifier: MIT
// What the fuzzers of image and machine file do with their bytes: load, use what was loaded, let only refusals pass.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "emulator/description/description.hpp"
#include "emulator/engines/image/backtrace.hpp"
#include "emulator/engines/image/debug_info.hpp"
#include "emulator/engines/image/image.hpp"
#include "emulator/errors.hpp"
#include "firmware/protocol/machine.hpp"

namespace torolux {

/// From each function: there, memory holds addresses of the same function.
inline void follow_calls(const Image& image, const DebugInfo& debug_info) {
  constexpr std::size_t kMostFollowed = 64;
  for (std::size_t i = 0; i < image.symbols.size() && i < kMostFollowed; ++i) {
    FrameRegisters frame;
    frame.pc = image.symbols[i].address + image.symbols[i].bytes / 2;
    for (auto& x : frame.x) x = protocol::kLocalMemoryBase;
    const CallStack stack = call_stack(image, debug_info, frame, [&frame](std::uint32_t) { return frame.pc; });
    if (stack.frames.empty() || stack.frames.size() > kMostFrames || in_words(stack).empty()) __builtin_trap();
  }
}

/// True: loaded. False: refused as bad input, with a message that names the file. Anything else ends the program.
inline bool load_elf(std::span<const std::byte> bytes) {
  try {
    const Image image = parse_image(bytes, "fuzzed.elf");
    for (const std::uint32_t address : {0x0U, protocol::kLocalMemoryBase, image.stores_begin - 1, 0xFFFF'FFFFU}) {
      if (image.describe(address).empty()) __builtin_trap();
    }
    std::vector<std::byte> memory(protocol::kSmallestLocalMemory);
    image.load_into(memory);
    follow_calls(image, DebugInfo({bytes.begin(), bytes.end()}));
    return true;
  } catch (const InputError& error) {
    if (!std::string(error.what()).starts_with("fuzzed.elf: ")) __builtin_trap();
    return false;
  }
}

inline bool load_machine_toml(const std::string& text) {
  try {
    const MachineDescription machine = parse_machine_description(text, "fuzzed.toml");
    if (machine.torus.link_cycles == 0 || !(machine.torus.link_error_rate <= 0.5)) __builtin_trap();
    return true;
  } catch (const InputError& error) {
    if (!std::string(error.what()).starts_with("fuzzed.toml:")) __builtin_trap();
    return false;
  }
}

}  // namespace torolux
